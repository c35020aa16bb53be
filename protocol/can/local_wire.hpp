#pragma once
// Packet format of a `local:` bus: the 16 bytes of Linux' struct can_frame (identifier u32 in host byte order, length
// u8, three unused bytes, eight data bytes), so that the `local:` and the `socketcan:` back end can share code.

#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>

#include "protocol/can/remote.hpp"

namespace ligature::can {

inline constexpr std::size_t kLocalPacketBytes = 16;
using LocalPacket = std::array<std::uint8_t, kLocalPacketBytes>;

[[nodiscard]] inline LocalPacket to_packet(const Frame& f) noexcept {
  LocalPacket p{};
  std::memcpy(p.data(), &f.id, 4);
  p[4] = f.dlc;
  std::memcpy(p.data() + 8, f.data.data(), 8);
  return p;
}

/// Empty for another size, more than 8 data bytes, or anything but a data or remote frame with an 11-bit identifier.
[[nodiscard]] inline std::optional<Frame> from_packet(std::span<const std::uint8_t> p) noexcept {
  if (p.size() != kLocalPacketBytes || p[4] > kMaxDlc) return std::nullopt;
  Frame f;
  std::memcpy(&f.id, p.data(), 4);
  if ((f.id & ~kRemoteBit) > kMaxId) return std::nullopt;  // the other upper bits mark extended and error frames
  f.dlc = p[4];
  if (is_remote(f)) return f;
  std::memcpy(f.data.data(), p.data() + 8, f.dlc);
  return f;
}

}  // namespace ligature::can
