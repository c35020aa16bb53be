#pragma once
// Scripts changed as a whole: another pose, the mirror image, another pace.

#include "protocol/scene/gripper_script.hpp"

namespace ligature::lab {

/// Mirrored in the plane x = 0, which maps the paper's frame and thread onto themselves.
[[nodiscard]] scene::GripperScript mirrored(scene::GripperScript script);

/// Turned about the z axis by an angle, rad.
[[nodiscard]] scene::GripperScript turned(scene::GripperScript script, double angle_rad);

/// Played `factor` times as fast.
[[nodiscard]] scene::GripperScript paced(scene::GripperScript script, double factor);

/// When each hand lets go for the last time, s; the script's end when it never does.
[[nodiscard]] double release_time_s(const scene::GripperScript& script);

}  // namespace ligature::lab
