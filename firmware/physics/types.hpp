#pragma once
// The vector type of the physics' interface: positions, velocities and forces in world coordinates.

#include <Eigen/Core>

namespace ligature::physics {

using Vec3 = Eigen::Vector3d;

}  // namespace ligature::physics
