#pragma once
// What joint torques may do at the tip, whatever the encoders say of where it is.

#include <array>
#include <cstddef>

#include "firmware/control/kinematics.hpp"

namespace ligature::control {

/// The largest tip force that joint torques make in any pose whose tip is in the device's workspace box: an upper bound
/// that knows no encoder, so that none can break it. It is a norm (convex, symmetric): torques between two that are
/// safe are safe.
///
/// omni-serial. With a = tau2 / l1 and b = tau3 / l2, the forces along which shoulder and forearm push the tip, and
/// x = sin(q3 - q2), the sine of the angle between the links, solving tau = J^T f gives
///   |f|^2 = tau1^2 / rho^2 + (a^2 + b^2 - 2 a b x) / (1 - x^2)
///         = u tau1^2 + v (a - b)^2 / 2 + w (a + b)^2 / 2,     u = 1 / rho^2,  v = 1 / (1 - x),  w = 1 / (1 + x)
/// The distance from the shoulder is rho^2 + z^2 = l1^2 + l2^2 + 2 l1 l2 x, so the pose matters by rho and z^2 alone.
/// The box's range of rho is cut into kSlices; in each, u, v and w are taken at their largest: rho at its near end, x
/// at its far and near end with the largest and smallest z^2. Within a tenth of what a search of the box finds.
/// Outside the box (arm nearly stretched, tip near the waist's axis) the same torques make more.
/// cartesian: |f| does not depend on the pose.
///
/// All O(1), no allocation.
class AnyPose {
 public:
  explicit AnyPose(const device::Device& device) noexcept;

  [[nodiscard]] double most_N(const Vec3& torque_Nm) const noexcept;
  /// Of all torques that are, joint by joint, between these two.
  [[nodiscard]] double most_N(const Vec3& low_Nm, const Vec3& high_Nm) const noexcept;

 private:
  static constexpr std::size_t kSlices = 6;
  struct Slice {
    double u = 0.0, v = 0.0, w = 0.0;  // u with tau1 as a force on lever 1
  };
  void cut(const device::Device& device) noexcept;
  /// Square of the force: of the waist's force squared, and of those along a and b.
  [[nodiscard]] double most_of_slices(double waist, double a, double b) const noexcept;

  Vec3 per_m_ = Vec3::Zero();  // joint torques to tau1 / 1 m, a, b
  std::array<Slice, kSlices> slices_{};
};

}  // namespace ligature::control
