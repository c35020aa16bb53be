#pragma once
// A classic CAN frame with an 11-bit identifier.

#include <array>
#include <cstdint>
#include <type_traits>

namespace ligature::can {

struct Frame {
  std::uint32_t id = 0;                ///< 11-bit identifier; CANopen's COB-ID
  std::uint8_t dlc = 0;                ///< number of data bytes, 0 .. 8
  std::array<std::uint8_t, 8> data{};  ///< bytes beyond dlc are zero

  friend constexpr bool operator==(const Frame&, const Frame&) = default;
};

inline constexpr std::uint32_t kMaxId = 0x7FF;
inline constexpr std::uint8_t kMaxDlc = 8;

static_assert(std::is_trivially_copyable_v<Frame>);  // passed between threads by memcpy

}  // namespace ligature::can
