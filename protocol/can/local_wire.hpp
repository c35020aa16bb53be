#pragma once
// Packet format of a `local:` bus: the 16 bytes of Linux' struct can_frame (identifier u32 in host byte order, length
// u8, three unused bytes, eight data bytes), or the 72 bytes of its struct canfd_frame (identifier, length, flags u8,
// two unused bytes, 64 data bytes), so that the `local:` and the `socketcan:` back end can share code.

#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>

#include "protocol/can/remote.hpp"

namespace ligature::can {

inline constexpr std::size_t kLocalPacketBytes = 16, kLocalFdPacketBytes = 72;
inline constexpr std::uint8_t kSwitchesRate = 1;  ///< flag of an FD frame

class LocalPacket {
 public:
  LocalPacket() = default;
  explicit LocalPacket(std::size_t size) noexcept : size_(size) {}
  [[nodiscard]] std::uint8_t* data() noexcept { return bytes_.data(); }
  [[nodiscard]] const std::uint8_t* data() const noexcept { return bytes_.data(); }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  std::uint8_t& operator[](std::size_t i) noexcept { return bytes_[i]; }
  [[nodiscard]] std::uint8_t* begin() noexcept { return data(); }
  [[nodiscard]] std::uint8_t* end() noexcept { return data() + size_; }
  [[nodiscard]] const std::uint8_t* begin() const noexcept { return data(); }
  [[nodiscard]] const std::uint8_t* end() const noexcept { return data() + size_; }

 private:
  std::array<std::uint8_t, kLocalFdPacketBytes> bytes_{};
  std::size_t size_ = kLocalPacketBytes;
};

[[nodiscard]] inline LocalPacket to_packet(const Frame& f) noexcept {
  const bool is_fd = f.format != Format::kClassic;
  LocalPacket p(is_fd ? kLocalFdPacketBytes : kLocalPacketBytes);
  std::memcpy(p.data(), &f.id, 4);
  p[4] = f.dlc;
  if (f.format == Format::kFdFast) p[5] = kSwitchesRate;
  std::memcpy(p.data() + 8, f.data.data(), p.size() - 8);
  return p;
}

/// Which frames a reader understands.
enum class Network : std::uint8_t {
  kClassic,  ///< classic data and remote frames with an 11-bit identifier
  kFd,       ///< FD frames and 29-bit identifiers as well
};

/// Empty for a packet of another size, more data bytes than its kind of frame allows, and frames of another network.
[[nodiscard]] inline std::optional<Frame> from_packet(std::span<const std::uint8_t> p,
                                                      Network network = Network::kClassic) noexcept {
  const bool is_fd = p.size() == kLocalFdPacketBytes;
  if (p.size() != kLocalPacketBytes && !(is_fd && network == Network::kFd)) return std::nullopt;
  Frame f;
  std::memcpy(&f.id, p.data(), 4);
  f.dlc = p[4];
  if (is_fd) f.format = (p[5] & kSwitchesRate) != 0 ? Format::kFdFast : Format::kFd;
  const bool may_be_long = network == Network::kFd && is_extended(f);
  // The other upper bits mark error frames, and extended ones that a classic reader does not want.
  if ((f.id & ~(kRemoteBit | (may_be_long ? kExtendedBit | kMaxExtendedId : kMaxId))) != 0) return std::nullopt;
  if (is_fd ? is_remote(f) || f.dlc != fd_length(f.dlc) : f.dlc > kMaxDlc) return std::nullopt;
  if (is_remote(f)) return f;
  std::memcpy(f.data.data(), p.data() + 8, f.dlc);
  return f;
}

}  // namespace ligature::can
