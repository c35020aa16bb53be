#pragma once
// A script's hands as the physics is told of them.

#include <array>

#include "firmware/physics/simulation.hpp"
#include "protocol/scene/gripper_script.hpp"

namespace ligature::lab {

/// Both tools at a time of the script, s; a hand without keys waits far away.
[[nodiscard]] std::array<physics::ToolInput, 2> tools_at(const scene::GripperScript& script, double t_s);

/// How long a run lasts that nobody gave a time: the script and nine seconds after; ten seconds when no hand is there.
[[nodiscard]] double default_duration_s(const scene::GripperScript& script);

}  // namespace ligature::lab
