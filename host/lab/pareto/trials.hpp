#pragma once
// What a setting errs by and what it costs.

#include <string>
#include <vector>

#include "host/lab/pareto/specimens.hpp"
#include "host/lab/statistics.hpp"

namespace ligature::lab {

/// A swing and a knot of one setting, to be compared with the finest one's.
struct Traces {
  std::vector<physics::Vec3> swing;  ///< the free end every 50 ms, m; level at first, held at the other end
  double hold_m = 0.0;               ///< between the hands in the hold, m
  double grip_m = 0.0;               ///< length of the thread, m
  double penetration = 0.0;          ///< worst of the pull, diameters
  std::string knot;                  ///< after the hold
  std::vector<double> us;            ///< thread-CPU time of every tick of the pull and the hold
  bool finite = true;
};

/// @param cost_only  the knot alone, for so many ticks (0: all)
[[nodiscard]] Traces run_trials(const Setting& setting, int cost_only = 0);

struct Errors {
  double shape = 0.0;  ///< worst static error of elastica and catenary, of L; NaN: not measured
  double swing = 0.0;  ///< rms distance of the free end, of L
  double knot = 0.0;   ///< difference of the distance between the hands at one force, diameters; NaN: knot lost
};

[[nodiscard]] Errors errors_of(const Setting& setting, const Traces& mine, const Traces& finest);

}  // namespace ligature::lab
