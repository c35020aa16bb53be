#pragma once
// The linkage of a Phantom-Omni-class hand: joint angles to tip position, and the way forces go back.

#include <array>

#include "firmware/physics/types.hpp"

namespace ligature::control {

using physics::Vec3;
using Mat3 = Eigen::Matrix3d;
using JointAngles = std::array<double, 3>;  ///< waist q1, shoulder q2, forearm q3 against the horizontal; rad

inline constexpr double kUpperArm_m = 0.134;    ///< l1
inline constexpr double kForearm_m = 0.1325;    ///< l2 = 0.080 + 0.0525, to the gimbal's centre
inline const Vec3 kHome_DT_m{0.0, -0.17, 0.0};  ///< tip position that maps to the workspace's origin

/// Tip T in the device base D (x right, y away from the person, z up).
///   rho = l1 cos q2 + l2 sin q3        reach, horizontally, out of the waist axis towards the person
///   p_DT = (rho sin q1, -rho cos q1, l1 sin q2 - l2 cos q3)
/// The parallel linkage drives the forearm from the base, so q3 is its absolute angle (0 hangs down) and does not
/// contain q2. O(1), no allocation; not-a-number in, not-a-number out.
[[nodiscard]] Vec3 tip_position(const JointAngles& q_rad) noexcept;

/// J = d p_DT / d q, m/rad: v_DT = J dq/dt. By differentiating the line above:
///   dp/dq1 = ( rho cos q1,           rho sin q1,           0         )
///   dp/dq2 = (-l1 sin q2 sin q1,     l1 sin q2 cos q1,     l1 cos q2 )
///   dp/dq3 = ( l2 cos q3 sin q1,    -l2 cos q3 cos q1,     l2 sin q3 )
[[nodiscard]] Mat3 tip_jacobian(const JointAngles& q_rad) noexcept;

/// Joint torques that hold a tip force, tau = J^T f (virtual work: tau . dq = f . dp). N m.
/// @param f_D_N force on the hand at the tip, N; + pushes the hand along +D.
[[nodiscard]] Vec3 joint_torque(const JointAngles& q_rad, const Vec3& f_D_N) noexcept;

/// Whether the angles can be those of this linkage: mechanical ranges of the Omni with 0.25 rad of margin.
[[nodiscard]] bool is_plausible(const JointAngles& q_rad) noexcept;

}  // namespace ligature::control
