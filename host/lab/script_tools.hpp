#pragma once
// Converts a script's keys to the tool input of the physics.

#include <array>

#include "firmware/physics/simulation.hpp"
#include "protocol/scene/gripper_script.hpp"

namespace ligature::lab {

/// Both tools at time t_s of the script; a hand without keys is placed far away.
[[nodiscard]] std::array<physics::ToolInput, 2> tools_at(const scene::GripperScript& script, double t_s);

/// Default duration of a run: the script and nine seconds more; ten seconds when the script has no keys.
[[nodiscard]] double default_duration_s(const scene::GripperScript& script);

}  // namespace ligature::lab
