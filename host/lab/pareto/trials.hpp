#pragma once
// Runs that measure the error and the cost of one numerical setting, for `ligature-lab pareto`.

#include <string>
#include <vector>

#include "host/lab/pareto/specimens.hpp"
#include "host/lab/statistics.hpp"

namespace ligature::lab {

/// Results of a swing and a knot at one setting, for comparison with the finest setting.
struct Traces {
  /// position of the free end every 50 ms, m; the thread starts horizontal, the other end is held
  std::vector<physics::Vec3> swing;
  double hold_m = 0.0;       ///< distance of the hands while the knot is held, m
  double grip_m = 0.0;       ///< length of the thread, m
  double penetration = 0.0;  ///< largest overlap during the pull, diameters
  std::string knot;          ///< type after the hold
  std::vector<double> us;    ///< thread CPU time of every tick of pull and hold
  bool finite = true;
};

/// @param cost_only number of ticks of the knot trial to run, without the swing; 0: run everything
[[nodiscard]] Traces run_trials(const Setting& setting, int cost_only = 0);

struct Errors {
  /// Largest error of the shapes at rest (elastica, catenary), relative to the length L; NaN: not measured
  double shape = 0.0;
  double swing = 0.0;  ///< rms distance of the swinging free end from the finest setting's, relative to L
  double knot = 0.0;   ///< difference of hold_m from the finest setting's, diameters; NaN: the knot was lost
};

[[nodiscard]] Errors errors_of(const Setting& setting, const Traces& mine, const Traces& finest);

}  // namespace ligature::lab
