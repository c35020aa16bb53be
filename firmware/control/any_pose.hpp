#pragma once
// Upper bound of the tip force that given joint torques make. It needs no pose, because the encoders may be wrong.

#include <array>
#include <cstddef>

#include "firmware/control/kinematics.hpp"

namespace ligature::control {

/// Largest tip force that joint torques can make in any pose with the tip inside the device's workspace box. No encoder
/// is used, so a wrong encoder cannot make this bound wrong. The bound is a norm of the torques (convex, symmetric):
/// any torque between two safe torques is safe.
///
/// Device kind omni-serial, with joint torques tau1 .. tau3, joint angles q1 .. q3 and link lengths l1, l2: let a =
/// tau2 / l1 and b = tau3 / l2 (forces at the tip due to shoulder and forearm torque) and x = sin(q3 - q2), the sine of
/// the angle between the links. Solving tau = J^T f gives
///   |f|^2 = tau1^2 / rho^2 + (a^2 + b^2 - 2 a b x) / (1 - x^2)
///         = u tau1^2 + v (a - b)^2 / 2 + w (a + b)^2 / 2,     u = 1 / rho^2,  v = 1 / (1 - x),  w = 1 / (1 + x)
/// rho is the tip's distance from the waist axis, z its height. Because rho^2 + z^2 = l1^2 + l2^2 + 2 l1 l2 x, the pose
/// enters only through rho and z^2. The box's range of rho is divided into kSlices. Each slice uses the largest values
/// of u, v and w: u at the least rho, v at the largest rho and z^2, w at the least rho and z^2. The bound is at most
/// 10 % above the maximum that a search of the box finds. Outside the box (arm nearly stretched, tip near the waist
/// axis) the same torques can make a larger force. Device kind cartesian: |f| does not depend on the pose.
///
/// All O(1), no allocation.
class AnyPose {
 public:
  explicit AnyPose(const device::Device& device) noexcept;

  [[nodiscard]] double most_N(const Vec3& torque_Nm) const noexcept;
  /// Largest tip force over all torques that lie, in each joint, between `low_Nm` and `high_Nm`.
  [[nodiscard]] double most_N(const Vec3& low_Nm, const Vec3& high_Nm) const noexcept;

 private:
  static constexpr std::size_t kSlices = 6;
  struct Slice {
    double u = 0.0, v = 0.0, w = 0.0;  // factors in the formula of |f|^2; u belongs to tau1 / 1 m
  };
  void cut(const device::Device& device) noexcept;
  /// Largest square of the tip force over all slices. @param waist (tau1 / 1 m)^2. @param a, b forces as in the class
  /// comment.
  [[nodiscard]] double most_of_slices(double waist, double a, double b) const noexcept;

  Vec3 per_m_ = Vec3::Zero();  // factors from joint torques to (tau1 / 1 m, a, b)
  std::array<Slice, kSlices> slices_{};
};

}  // namespace ligature::control
