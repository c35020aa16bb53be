#pragma once
// Computes the tip's position and Jacobian from joint angles, for each kind of device.

#include <array>

#include "firmware/physics/types.hpp"
#include "protocol/device/device.hpp"

namespace ligature::control {

using physics::Vec3;
using Mat3 = Eigen::Matrix3d;
using JointAngles = std::array<double, 3>;  ///< rad, as the drives report them

[[nodiscard]] inline Vec3 vector_of(const std::array<double, 3>& a) noexcept { return {a[0], a[1], a[2]}; }

/// Lever arm of each joint in the home pose, |dp/dq_j| in m: the joint's torque per newton of tip force in the
/// direction in which the joint moves the tip.
[[nodiscard]] Vec3 levers_at_home_m(const device::Device& device) noexcept;

/// Computes the position p_DT of the tip T in the device's base frame D (x right, y away from the person, z up), and
/// the Jacobian J = d p_DT / d q.
///
/// Device kind omni-serial: waist angle q1, shoulder q2, forearm q3 against the vertical; link lengths l1, l2.
///   rho  = l1 cos q2 + l2 sin q3        horizontal distance of the tip from the waist axis, towards the person
///   p_DT = (rho sin q1, -rho cos q1, l1 sin q2 - l2 cos q3)
/// The parallel linkage drives the forearm from the base, so q3 is an absolute angle (0: hangs down) that does not
/// contain q2. By differentiation:
///   dp/dq1 = ( rho cos q1,           rho sin q1,           0         )
///   dp/dq2 = (-l1 sin q2 sin q1,     l1 sin q2 cos q1,     l1 cos q2 )
///   dp/dq3 = ( l2 cos q3 sin q1,    -l2 cos q3 cos q1,     l2 sin q3 )
///
/// Device kind cartesian: p_DT = home + (r1 q1, r2 q2, r3 q3); r1, r2, r3: radii of the cable drums.
///
/// All O(1), no allocation. If an angle is not a number, the results are not numbers either.
class Linkage {
 public:
  explicit Linkage(const device::Device& device) noexcept;

  [[nodiscard]] Vec3 position(const JointAngles& q_rad) const noexcept;
  [[nodiscard]] Mat3 jacobian(const JointAngles& q_rad) const noexcept;  ///< m/rad: v_DT = J dq/dt

  /// Joint torques tau, N m, that produce the tip force f: tau = J^T f (virtual work: tau . dq = f . dp).
  /// @param f_D_N force on the hand at the tip, N; a positive component pushes the hand along that axis of D
  [[nodiscard]] Vec3 torque(const JointAngles& q_rad, const Vec3& f_D_N) const noexcept {
    return jacobian(q_rad).transpose() * f_D_N;
  }

  /// Whether this device can have these angles: they lie between its stops, with a margin of 0.25 rad.
  [[nodiscard]] bool is_plausible(const JointAngles& q_rad) const noexcept;

  /// For each joint: whether it is more than 0.05 rad from its stops.
  [[nodiscard]] std::array<bool, 3> far_from_stops(const JointAngles& q_rad) const noexcept;

  /// Tip position, in device coordinates, that the workspace map puts at its origin
  [[nodiscard]] const Vec3& home_m() const noexcept { return home_m_; }

 private:
  device::Kinematics kind_;
  Vec3 links_m_, home_m_;
  JointAngles min_rad_, max_rad_;
};

}  // namespace ligature::control
