#pragma once
// A CAN frame: classic with an 11-bit identifier, or of a CAN-FD network.

#include <array>
#include <cstdint>
#include <type_traits>

namespace ligature::can {

enum class Format : std::uint8_t {
  kClassic,
  kFd,      ///< up to 64 bytes
  kFdFast,  ///< the same, with its data at the faster bit rate (bit-rate switch)
};

struct Frame {
  std::uint32_t id = 0;                 ///< 11-bit identifier, CANopen's COB-ID; or 29 bits with kExtendedBit
  std::uint8_t dlc = 0;                 ///< number of data bytes: 0 .. 8; in FD also 12, 16, 20, 24, 32, 48 and 64
  std::array<std::uint8_t, 64> data{};  ///< bytes beyond dlc are zero
  Format format = Format::kClassic;

  friend constexpr bool operator==(const Frame&, const Frame&) = default;
};

inline constexpr std::uint32_t kMaxId = 0x7FF;
inline constexpr std::uint32_t kExtendedBit = 0x8000'0000;  ///< of Frame::id, as in Linux' struct can_frame
inline constexpr std::uint32_t kMaxExtendedId = 0x1FFF'FFFF;
inline constexpr std::uint8_t kMaxDlc = 8;  ///< of a classic frame

[[nodiscard]] constexpr bool is_extended(const Frame& f) noexcept { return (f.id & kExtendedBit) != 0; }

/// The shortest length of an FD frame that has room for so many bytes.
[[nodiscard]] constexpr std::uint8_t fd_length(std::size_t bytes) noexcept {
  if (bytes <= kMaxDlc) return static_cast<std::uint8_t>(bytes);
  for (const unsigned length : {12U, 16U, 20U, 24U, 32U, 48U})
    if (bytes <= length) return static_cast<std::uint8_t>(length);
  return 64;
}

static_assert(std::is_trivially_copyable_v<Frame>);  // passed between threads by memcpy

}  // namespace ligature::can
