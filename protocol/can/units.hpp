#pragma once
// Conversion between counts or per mille and SI units for the shipped device; other devices use their record's values.

#include <cstdint>
#include <numbers>

#include "protocol/can/device_profile.hpp"

namespace ligature::can {

/// Nearest integer, halves away from zero, clipped to +-limit; NaN gives 0.
[[nodiscard]] constexpr std::int32_t round_clipped(double value, std::int32_t limit) noexcept {
  if (!(value == value)) return 0;
  if (value >= limit) return limit;
  if (value <= -limit) return -limit;
  return static_cast<std::int32_t>(value < 0.0 ? value - 0.5 : value + 0.5);
}

inline constexpr double kRadPerCount = 2.0 * std::numbers::pi / profile::kCountsPerRevolution;
inline constexpr double kNmPerPermille = profile::kRatedTorque_mNm * 1e-3 * 1e-3;

/// Joint angle of an absolute encoder whose count 0 is angle 0. Resolution 0.38 mrad.
[[nodiscard]] constexpr double angle_rad(std::int32_t counts) noexcept { return counts * kRadPerCount; }
[[nodiscard]] constexpr std::int32_t counts_of(double angle_rad) noexcept {
  return round_clipped(angle_rad / kRadPerCount, 0x3FFF'FFFF);
}

/// Joint torque from its value on the wire, N m. Resolution 0.3 mN m.
[[nodiscard]] constexpr double torque_Nm(std::int16_t permille) noexcept { return permille * kNmPerPermille; }

/// Value on the wire for a joint torque, clipped to the drive's maximum; NaN gives 0.
[[nodiscard]] constexpr std::int16_t permille_of(double torque_Nm) noexcept {
  return static_cast<std::int16_t>(round_clipped(torque_Nm / kNmPerPermille, profile::kMaxTorque_permille));
}

static_assert(counts_of(angle_rad(-12345)) == -12345 && permille_of(torque_Nm(-2999)) == -2999);
static_assert(permille_of(1e9) == 3000 && permille_of(-1e9) == -3000);

}  // namespace ligature::can
