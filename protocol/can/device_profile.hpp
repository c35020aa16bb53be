#pragma once
// Constants of the Omni-class device on the bus. Used only by protocol/can and the simulated drives.

#include <array>
#include <cstdint>

#include "protocol/can/cob_id.hpp"
#include "protocol/can/omni_drives.hpp"

namespace ligature::can::profile {

inline constexpr std::array kJointNodes{kWaist, kShoulder, kElbow};

inline constexpr std::uint32_t kBitRate = 1'000'000;  ///< bit/s
inline constexpr std::int64_t kBitTime_ns = 1'000'000'000 / kBitRate;

/// Rounds a positive number to the nearest integer; std::lround is not constexpr.
template <class Integer>
constexpr Integer nearest(double value) noexcept {
  const auto below = static_cast<Integer>(value);
  return static_cast<Integer>(value - below < 0.5 ? below : below + 1);
}

/// Constants of the shipped device; those of other devices are only in their records.
inline constexpr auto kCountsPerRevolution = nearest<std::int32_t>(omni::kMotorCounts * omni::kGear);
inline constexpr auto kRatedTorque_mNm = nearest<std::uint32_t>(1e3 * omni::kRatedTorque_Nm);
inline constexpr auto kMaxTorque_permille = static_cast<std::int16_t>(omni::kMaxTorque_permille);

/// Torque deviation above which a drive sets kTorqueAstrayBit.
inline constexpr int kTorqueTolerance_permille = 50;

inline constexpr std::int8_t kCyclicSynchronousTorque = 10;  ///< mode of operation (object 0x6060)
inline constexpr std::uint8_t kSynchronousEverySync = 1;     ///< PDO transmission type: at each SYNC

inline constexpr std::uint16_t kButtonGrip = 1U << 0;
inline constexpr std::uint16_t kButtonDeadMan = 1U << 1;
inline constexpr std::uint16_t kButtonClutch = 1U << 2;
/// Bits 3 .. 7 of the buttons' word, for the node whose TPDO has no room for a torque: number of SYNCs (up to 31) for
/// which the drive has repeated its torque because no new RPDO came.
[[nodiscard]] constexpr std::uint16_t with_held(std::uint16_t buttons, int syncs) noexcept {
  const unsigned told = syncs < 0 ? 0U : syncs > 31 ? 31U : static_cast<unsigned>(syncs);
  return static_cast<std::uint16_t>((buttons & 0xFF07U) | (told << 3U));
}
[[nodiscard]] constexpr int held_of(std::uint16_t buttons) noexcept { return (buttons >> 3U) & 31; }
/// Bits 8 .. 15 of the buttons' word: a counter that increases at each SYNC. If it stands still, the button readings
/// are not updated.
[[nodiscard]] constexpr std::uint16_t with_life(std::uint16_t buttons, std::uint8_t life) noexcept {
  return static_cast<std::uint16_t>((buttons & 0x00FFU) | (static_cast<unsigned>(life) << 8U));
}
[[nodiscard]] constexpr std::uint8_t life_of(std::uint16_t buttons) noexcept {
  return static_cast<std::uint8_t>(buttons >> 8U);
}

inline constexpr std::uint16_t kDefaultRpdoTimeout_ms = 20;
inline constexpr std::uint16_t kDefaultHeartbeat_ms = 100;         ///< heartbeat period of the drives and of the master
inline constexpr std::uint16_t kDefaultHeartbeatTimeout_ms = 300;  ///< three heartbeats lost in a row

[[nodiscard]] constexpr bool has_stylus_buttons(NodeId node) noexcept { return node == kElbow; }

}  // namespace ligature::can::profile
