#pragma once
// Makes loosely tied knots for the planner: one script, with different random hand motion each time.

#include <cstdint>
#include <string>

#include "host/lab/rehearsal.hpp"

namespace ligature::lab {

struct LooseKnot {
  scene::Scene scene;
  physics::Simulation thread;  ///< released, and at rest for three seconds
  std::string type;
  std::uint32_t seed = 0;
};

/// Ties the script's knot with disturbed hand motion (each key moved by up to 1.5 cm, speed changed by up to 5 %) and
/// releases it; with 35 and 50 nodes in turn. Repeats with other seeds until the knot is of `type`.
/// @param number index in a series, from 0;  @param drawn is increased by the number of tries.
[[nodiscard]] LooseKnot tie_loosely(const std::string& scene_path, const scene::GripperScript& script,
                                    const std::string& type, std::uint32_t number, int& drawn);

}  // namespace ligature::lab
