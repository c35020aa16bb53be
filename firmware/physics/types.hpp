#pragma once
// The vector of the physics' outside: positions, velocities and forces in world coordinates.

#include <Eigen/Core>

namespace ligature::physics {

using Vec3 = Eigen::Vector3d;

}  // namespace ligature::physics
