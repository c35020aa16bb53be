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
/// Order in which waiting frames get the bus, the smallest first. A data frame goes before the request for it.
[[nodiscard]] constexpr std::uint32_t rank_of(const Frame& f) noexcept {
  return ((f.id & kMaxId) << 1U) | (is_remote(f) ? 1U : 0U);
}

}  // namespace ligature::can
