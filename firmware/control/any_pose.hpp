#pragma once
// Upper bound of the tip force of given joint torques that holds without knowing the pose (encoders may be wrong).

#include <array>
#include <cstddef>

#include "firmware/control/kinematics.hpp"

namespace ligature::control {

/// Largest tip force that joint torques make in any pose with the tip inside the device's workspace box. It uses no
/// encoder, so a wrong encoder cannot invalidate it. It is a norm (convex, symmetric): any torque between two safe
/// torques is safe.
///
/// Device kind omni-serial: let a = tau2 / l1 and b = tau3 / l2 (forces at the tip due to shoulder and forearm torque)
/// and x = sin(q3 - q2), the sine of the angle between the links. Solving tau = J^T f gives
///   |f|^2 = tau1^2 / rho^2 + (a^2 + b^2 - 2 a b x) / (1 - x^2)
///         = u tau1^2 + v (a - b)^2 / 2 + w (a + b)^2 / 2,     u = 1 / rho^2,  v = 1 / (1 - x),  w = 1 / (1 + x)
/// rho is the tip's distance from the waist axis. With rho^2 + z^2 = l1^2 + l2^2 + 2 l1 l2 x the pose enters only
/// through rho and z^2. The box's range of rho is divided into kSlices. In each slice u, v and w take their largest
/// values: u at the least rho, v at the largest rho and z^2, w at the least rho and z^2. The result is at most 10 %
/// above the maximum found by a search of the box. Outside the box (arm nearly stretched, tip near the waist axis) the
/// same torques can make a larger force. Device kind cartesian: |f| does not depend on the
/// pose.
///
/// All O(1), no allocation.
class AnyPose {
 public:
  explicit AnyPose(const device::Device& device) noexcept;

  [[nodiscard]] double most_N(const Vec3& torque_Nm) const noexcept;
  /// Largest tip force over all torques that lie, joint by joint, between these two.
  [[nodiscard]] double most_N(const Vec3& low_Nm, const Vec3& high_Nm) const noexcept;

 private:
  static constexpr std::size_t kSlices = 6;
  struct Slice {
    double u = 0.0, v = 0.0, w = 0.0;  // factors in the formula of |f|^2; u belongs to tau1 / 1 m
  };
  void cut(const device::Device& device) noexcept;
  /// Largest square of the tip force over all slices. @param waist  (tau1 / 1 m)^2. @param a, b  as in the class
  /// comment.
  [[nodiscard]] double most_of_slices(double waist, double a, double b) const noexcept;

  Vec3 per_m_ = Vec3::Zero();  // factors from joint torques to (tau1 / 1 m, a, b)
  std::array<Slice, kSlices> slices_{};
};

}  // namespace ligature::control
