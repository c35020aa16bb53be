#pragma once
// One trial of `extremes`: plays a script on a scene for some ticks and reports how it ended.

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "host/lab/rehearsal.hpp"
#include "host/lab/report.hpp"

namespace ligature::lab {

/// How a trial ended.
struct Ending {
  std::string word;  ///< "finite", "stopped", "refused", or "LEAKED": the physics returned a non-finite number
  double tick = 0.0;
  double node = 0.0;  ///< -1: no node, or the cause was a hand
  std::string cause;
  bool by_hand = false;  ///< stopped because the script gave a hand an invalid position, before the thread was affected
};

[[nodiscard]] Ending trial(const scene::Scene& scene, const scene::GripperScript& script, int ticks);

/// A parameter that is varied, and how a factor is applied to it.
struct Dial {
  const char* name;
  int low, high;  ///< range of the factor, as powers of ten
  std::function<void(scene::Scene&, double)> turn;
};

/// Trials of unusual scenes: name and ending of each.
using OddEndings = std::vector<std::pair<std::string, Ending>>;

/// Tables and counts of all trials of one model.
struct ExtremesMap {
  Table map{{"parameter", "factor", "step_s", "ending", "tick", "node", "likely_cause"}};
  Table odd{{"case", "ending", "tick", "node", "likely_cause"}};
  int trials = 0, finite = 0, refused = 0, leaked = 0, unnamed = 0;
  bool as_shipped = false;  ///< finite at 1 ms with all parameters unchanged

  void add(const char* parameter, double factor, double step_s, const Ending& e);
  void add(const std::string& odd_case, const Ending& e);

 private:
  void count(const Ending& e);
};

/// All trials of the rod, on scenes/suture-3-0.toml and suture-3-0-knot.toml: every parameter over its range at six
/// time steps, and unusual scenes.
[[nodiscard]] ExtremesMap rod_extremes(const std::filesystem::path& scenes);

}  // namespace ligature::lab
