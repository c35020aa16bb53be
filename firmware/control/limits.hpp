#pragma once
// Limit on a force's magnitude. A force that reaches the limit is normal and only reported; a force that is not finite
// is a fault.

#include <limits>

#include "firmware/physics/types.hpp"

namespace ligature::control {

/// Factor on the device's velocity limit. Above the limit the rig only brakes, because a hand may slip. Above this
/// factor times the limit it is a fault, because only a broken encoder reports such a speed.
inline constexpr double kVelocityFault = 1.5;

struct LimitedForce {
  physics::Vec3 f_N = physics::Vec3::Zero();
  bool limited = false;
  bool finite = true;
};

/// Clips the force's magnitude and keeps its direction. The limit used is a few rounding errors below max_N, so that
/// |f| <= max_N always holds. The motors' force still differs by the torque quantum on the wire: 1 per mille, 0.3 mN m,
/// at most 2 mN at the tip. NaN and infinity give zero force and `finite` false.
[[nodiscard]] inline LimitedForce saturate(const physics::Vec3& f_N, double max_N) noexcept {
  if (!f_N.allFinite()) return {physics::Vec3::Zero(), false, false};
  const double magnitude_N = f_N.norm();
  if (magnitude_N <= max_N) return {f_N, false, true};
  const physics::Vec3 direction = f_N / f_N.cwiseAbs().maxCoeff();  // the norm itself may overflow
  constexpr double kRounding = 1.0 - 4.0 * std::numeric_limits<double>::epsilon();
  return {direction * (max_N * kRounding / direction.norm()), true, true};
}

}  // namespace ligature::control
