#pragma once
// What one tick of an offline run left behind, and what to say of one that was no number.

#include <cstdint>
#include <string>

#include "firmware/physics/simulation.hpp"
#include "host/lab/run_files.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::lab {

/// The row of the tick that ended at t_s. Where no pair of strands is near the gap is the thread's length: tables hold
/// finite numbers only.
[[nodiscard]] TraceRow row_of(const physics::Simulation& simulation, const scene::Scene& scene, double t_s,
                              double step_us = 0.0);

/// One line about a run that is no number any more: tick, node, likely cause.  @param tick  the last one done.
[[nodiscard]] std::string divergence(const physics::Diagnostics& diagnostics, const scene::Scene& scene,
                                     std::int64_t tick, double t_s);

}  // namespace ligature::lab
