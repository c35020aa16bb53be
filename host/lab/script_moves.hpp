#pragma once
// Transformations of a whole script: rotation, mirror image, speed.

#include "protocol/scene/gripper_script.hpp"

namespace ligature::lab {

/// The script's mirror image in the plane x = 0, which maps the paper's frame and thread onto themselves.
[[nodiscard]] scene::GripperScript mirrored(scene::GripperScript script);

/// The script rotated about the z axis by an angle, rad.
[[nodiscard]] scene::GripperScript turned(scene::GripperScript script, double angle_rad);

/// The script played at `factor` times the speed.
[[nodiscard]] scene::GripperScript paced(scene::GripperScript script, double factor);

/// Time of the last release of the last hand, s; the script's end when no hand releases.
[[nodiscard]] double release_time_s(const scene::GripperScript& script);

}  // namespace ligature::lab
