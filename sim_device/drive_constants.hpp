#pragma once
// Constants of a drive: values in its object dictionary, and the scale of its counts and per mille.

#include <cstdint>
#include <numbers>

#include "protocol/can/units.hpp"

namespace ligature::sim {

struct DriveConstants {
  /// Encoder counts per revolution of the joint
  std::uint32_t counts_per_revolution = can::profile::kCountsPerRevolution;
  std::uint32_t rated_torque_mNm = can::profile::kRatedTorque_mNm;
  std::int32_t max_torque_permille = can::profile::kMaxTorque_permille;

  /// Counts of an absolute encoder whose count 0 is angle 0, rounded.
  [[nodiscard]] std::int32_t counts_of(double angle_rad) const noexcept {
    const double rad_per_count = 2.0 * std::numbers::pi / counts_per_revolution;
    return can::round_clipped(angle_rad / rad_per_count, 0x3FFF'FFFF);
  }
  [[nodiscard]] double torque_Nm(std::int16_t permille) const noexcept {
    return permille * (rated_torque_mNm * 1e-3 * 1e-3);
  }
};

}  // namespace ligature::sim
