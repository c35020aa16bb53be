#pragma once
// Experiments that others published: what a case measures; the list of cases. @see docs/measurements/published.md

#include <span>
#include <string>
#include <vector>

#include "host/lab/validate/cases.hpp"

namespace ligature::published {

using validate::Finding;

/// How a case is run.
struct Subject {
  scene::Accuracy accuracy = scene::Accuracy::kBalanced;
  bool quick = false;  ///< fewer or smaller runs: at most 20 s of CPU time
  long work = 0;       ///< contact budget of a tick, in instructions; 0: that of the accuracy

  /// The rod with this many nodes, for the threads of `validate`.
  [[nodiscard]] validate::Subject rod(int nodes) const { return {scene::Model::kRod, nodes, accuracy, work}; }
};

/// One point of a case's picture. NaN: there is no theory, or no measurement, at x.
struct Point {
  std::string curve;
  double x = 0.0, theory = 0.0, measured = 0.0;
};

struct Result {
  std::vector<Finding> findings;
  std::vector<Point> points;
};

struct Case {
  const char* name;
  const char* about;            ///< what is compared, in a few words
  const char* source;           ///< who published it
  const char *x_axis, *y_axis;  ///< of the picture
  Result (*measure)(const Subject&);
};

/// All cases, in the order of the printed table.
[[nodiscard]] std::span<const Case> all_cases();

/// A figure that is reported without a verdict, because no published number exists for it. A value of NaN still counts
/// as a miss.
[[nodiscard]] Finding reported(std::string what, double measured, std::string unit);
[[nodiscard]] bool is_judged(const Finding& f) noexcept;

// The cases, one file each.
Result trefoil(const Subject&);
Result braid(const Subject&);
Result helices(const Subject&);
Result ply(const Subject&);
Result locking(const Subject&);
Result threshold(const Subject&);
Result cyclic(const Subject&);
Result post(const Subject&);
Result capstan(const Subject&);
Result capstan_axis(const Subject&);
Result drum(const Subject&);

}  // namespace ligature::published
