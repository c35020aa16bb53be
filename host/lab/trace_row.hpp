#pragma once
// The result row of a tick of an offline run, and the message for a run that diverged.

#include <cstdint>
#include <string>

#include "firmware/physics/simulation.hpp"
#include "host/lab/run_files.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::lab {

/// The row of the tick that ended at t_s. When no two strands are near each other, the gap is given as the thread's
/// length, because tables hold finite numbers only.
[[nodiscard]] TraceRow row_of(const physics::Simulation& simulation, const scene::Scene& scene, double t_s,
                              double step_us = 0.0);

/// One line about a run that became non-finite: tick, node, likely cause.  @param tick number of the last tick.
[[nodiscard]] std::string divergence(const physics::Diagnostics& diagnostics, const scene::Scene& scene,
                                     std::int64_t tick, double t_s);

}  // namespace ligature::lab
