#pragma once
// Numbers of the Omni-class device that the wire depends on. Only protocol/can and the drives know them.

#include <array>
#include <cstdint>

#include "protocol/can/cob_id.hpp"
#include "protocol/can/omni_drives.hpp"

namespace ligature::can::profile {

inline constexpr std::array kJointNodes{kWaist, kShoulder, kElbow};

inline constexpr std::uint32_t kBitRate = 1'000'000;  ///< bit/s
inline constexpr std::int64_t kBitTime_ns = 1'000'000'000 / kBitRate;

/// The nearest number to a positive one; std::lround is no constant expression.
template <class Integer>
constexpr Integer nearest(double value) noexcept {
  const auto below = static_cast<Integer>(value);
  return static_cast<Integer>(value - below < 0.5 ? below : below + 1);
}

/// Of the shipped device's joints and drives; another device's are in its record alone.
inline constexpr auto kCountsPerRevolution = nearest<std::int32_t>(omni::kMotorCounts * omni::kGear);
inline constexpr auto kRatedTorque_mNm = nearest<std::uint32_t>(1e3 * omni::kRatedTorque_Nm);
inline constexpr auto kMaxTorque_permille = static_cast<std::int16_t>(omni::kMaxTorque_permille);

/// What a drive's torque may be off before it says so (kTorqueAstrayBit).
inline constexpr int kTorqueTolerance_permille = 50;

inline constexpr std::int8_t kCyclicSynchronousTorque = 10;  ///< value of 0x6060
inline constexpr std::uint8_t kSynchronousEverySync = 1;     ///< PDO transmission type

inline constexpr std::uint16_t kButtonGrip = 1U << 0;
inline constexpr std::uint16_t kButtonDeadMan = 1U << 1;
inline constexpr std::uint16_t kButtonClutch = 1U << 2;
/// Bits 3 .. 7 of the buttons' word: SYNCs, up to 31, at which the drive had no new RPDO and kept the torque it made in
/// the period that the message tells of. Its TPDO has no room for the torque itself.
[[nodiscard]] constexpr std::uint16_t with_held(std::uint16_t buttons, int syncs) noexcept {
  const unsigned told = syncs < 0 ? 0U : syncs > 31 ? 31U : static_cast<unsigned>(syncs);
  return static_cast<std::uint16_t>((buttons & 0xFF07U) | (told << 3U));
}
[[nodiscard]] constexpr int held_of(std::uint16_t buttons) noexcept { return (buttons >> 3U) & 31; }
/// Bits 8 .. 15 of the buttons' word: a life sign, one more at each SYNC. A word that stands still is a sensor that
/// does.
[[nodiscard]] constexpr std::uint16_t with_life(std::uint16_t buttons, std::uint8_t life) noexcept {
  return static_cast<std::uint16_t>((buttons & 0x00FFU) | (static_cast<unsigned>(life) << 8U));
}
[[nodiscard]] constexpr std::uint8_t life_of(std::uint16_t buttons) noexcept {
  return static_cast<std::uint8_t>(buttons >> 8U);
}

inline constexpr std::uint16_t kDefaultRpdoTimeout_ms = 20;
inline constexpr std::uint16_t kDefaultHeartbeat_ms = 100;         ///< both ways
inline constexpr std::uint16_t kDefaultHeartbeatTimeout_ms = 300;  ///< three lost in a row

[[nodiscard]] constexpr bool has_stylus_buttons(NodeId node) noexcept { return node == kElbow; }

}  // namespace ligature::can::profile
