#pragma once
// Limits are reported, faults are latched: a saturated force is normal life, a force that is no number is not.

#include <limits>

#include "firmware/physics/types.hpp"

namespace ligature::control {

/// Times the device's velocity limit: the limit brakes, as a hand may slip; this no hand does, but a broken encoder.
inline constexpr double kVelocityFault = 1.5;

struct LimitedForce {
  physics::Vec3 f_N = physics::Vec3::Zero();
  bool limited = false;
  bool finite = true;
};

/// Keeps the direction and clips the magnitude: |f| ≤ max_N, also when f's own rounding counts against it (hence a few
/// ulps less than max_N). What the motors make of it differs by the wire's resolution: torques are rounded to 1 per
/// mille, 0.3 mN m, which is at most 2 mN at the tip. Not-a-number and infinity become zero and are told.
[[nodiscard]] inline LimitedForce saturate(const physics::Vec3& f_N, double max_N) noexcept {
  if (!f_N.allFinite()) return {physics::Vec3::Zero(), false, false};
  const double magnitude_N = f_N.norm();
  if (magnitude_N <= max_N) return {f_N, false, true};
  const physics::Vec3 direction = f_N / f_N.cwiseAbs().maxCoeff();  // the norm itself may overflow
  constexpr double kRounding = 1.0 - 4.0 * std::numeric_limits<double>::epsilon();
  return {direction * (max_N * kRounding / direction.norm()), true, true};
}

}  // namespace ligature::control
