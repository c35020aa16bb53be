#pragma once
// Remote frames: a request for the data frame of the same identifier. As in Linux' struct can_frame, a bit of the
// identifier marks them. They carry no data; their length is that of the data frame.

#include "protocol/can/frame.hpp"

namespace ligature::can {

inline constexpr std::uint32_t kRemoteBit = 0x4000'0000;

[[nodiscard]] constexpr bool is_remote(const Frame& f) noexcept { return (f.id & kRemoteBit) != 0; }
[[nodiscard]] constexpr Frame remote_frame(std::uint32_t id, std::uint8_t dlc) noexcept {
  return {id | kRemoteBit, dlc, {}};
}
/// Order in which waiting frames get the bus, the smallest first: the first bits of the frame. A data frame goes before
/// the request for it, and a frame with an 11-bit identifier before those whose 29 bits begin with the same 11.
[[nodiscard]] constexpr std::uint32_t rank_of(const Frame& f) noexcept {
  const std::uint32_t remote = is_remote(f) ? 1U : 0U;
  if (!is_extended(f)) return (f.id & kMaxId) << 21U | remote << 20U;
  const std::uint32_t id = f.id & kMaxExtendedId;
  return id >> 18U << 21U | 3U << 19U | (id & 0x3FFFFU) << 1U | remote;
}

}  // namespace ligature::can
