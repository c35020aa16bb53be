#pragma once
// Numbers of the Omni-class device that the wire depends on. Only protocol/can and the drives know them.

#include <array>
#include <cstdint>

#include "protocol/can/cob_id.hpp"

namespace ligature::can::profile {

inline constexpr std::array kJointNodes{kWaist, kShoulder, kElbow};

inline constexpr std::uint32_t kBitRate = 1'000'000;  ///< bit/s
inline constexpr std::int64_t kBitTime_ns = 1'000'000'000 / kBitRate;

/// Encoder counts of one joint revolution. Assumption: the maker publishes none; 0.055 mm nominal tip resolution
/// at 0.1325 m is 0.41 mrad, i.e. about 15.4 k counts, and 2^14 is the next size encoders are made in.
inline constexpr std::int32_t kCountsPerRevolution = 16384;

/// 3.3 N at the full reach of 0.2665 m is 0.88 N m; 3 x 0.3 N m covers it with 1 per mille = 0.3 mN m = 2 mN at the
/// tip.
inline constexpr std::uint32_t kRatedTorque_mNm = 300;
inline constexpr std::int16_t kMaxTorque_permille = 3000;

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
