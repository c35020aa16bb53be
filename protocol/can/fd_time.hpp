#pragma once
// Duration of a CAN-FD frame (ISO 11898-1:2015), and of any frame. From the start bit to the bit-rate switch (BRS) an
// FD frame has 17 bits, or 36 with a 29-bit identifier. Then come ESI, 4 bits of length and the data, at the faster
// rate; up to here the bits are stuffed as in classic CAN. Then 4 bits of stuff count and a CRC of 17 bits (up to 16
// data bytes) or 21, in which stuff bits have fixed places: one before them and one after every fourth. The last 13
// bits are slow again: CRC delimiter, acknowledge and its delimiter, end of frame, interframe space.

#include "protocol/can/bit_time.hpp"

namespace ligature::can {

inline constexpr std::int64_t kFastBitTime_ns = 200;  ///< 5 Mbit/s

/// Bits of a frame at the slow and at the fast rate.
struct BitCount {
  unsigned slow = 0, fast = 0;
  [[nodiscard]] constexpr std::int64_t ns() const noexcept { return bits_to_ns(slow) + fast * kFastBitTime_ns; }
};

namespace detail {
inline constexpr unsigned kFdTailBits = 13, kFdControlBits = 5;
[[nodiscard]] constexpr unsigned fd_head_bits(bool extended) noexcept { return extended ? 36 : 17; }
[[nodiscard]] constexpr unsigned fd_crc_bits(unsigned bytes) noexcept {
  const unsigned bits = 4 + (bytes > 16 ? 21 : 17);
  return bits + 1 + bits / 4;
}
}  // namespace detail

/// Of an FD frame with bit-rate switch, without stuff bits.
[[nodiscard]] constexpr BitCount min_fd_bits(unsigned bytes, bool extended) noexcept {
  return {detail::fd_head_bits(extended) + detail::kFdTailBits,
          detail::kFdControlBits + 8 * bytes + detail::fd_crc_bits(bytes)};
}
/// With as many stuff bits as there can be, as many of them slow as there can be.
[[nodiscard]] constexpr BitCount max_fd_bits(unsigned bytes, bool extended) noexcept {
  const unsigned head = detail::fd_head_bits(extended);
  const unsigned all = (head + detail::kFdControlBits + 8 * bytes - 1) / 4, slow = (head - 1) / 4;
  BitCount bits = min_fd_bits(bytes, extended);
  bits.slow += slow;
  bits.fast += all - slow;
  return bits;
}

/// Exact numbers for this FD frame, with stuff bits and interframe space.
[[nodiscard]] constexpr BitCount fd_bits(const Frame& f) noexcept {
  BitCount bits = min_fd_bits(f.dlc, is_extended(f));
  StuffRun run;
  bool ends_in_run = false;
  const auto push = [&](std::uint32_t value, int count) {
    unsigned inserted = 0;
    for (int i = count - 1; i >= 0; --i) {
      ends_in_run = run.push((value >> i & 1U) != 0);
      inserted += ends_in_run ? 1U : 0U;
    }
    return inserted;
  };
  const std::uint32_t switches = f.format == Format::kFdFast ? 1U : 0U;
  bits.slow += push(0, 1);  // start of frame
  if (is_extended(f)) {
    bits.slow += push((f.id & kMaxExtendedId) >> 18U, 11) + push(3, 2) + push(f.id & 0x3FFFFU, 18);  // SRR, IDE
    bits.slow += push(0b0100U | switches, 4);  // RRS, FDF, res, BRS
  } else {
    bits.slow += push(f.id & kMaxId, 11) + push(0b00100U | switches, 5);  // RRS, IDE, FDF, res, BRS
  }
  unsigned code = f.dlc;
  if (f.dlc > kMaxDlc) code = f.dlc <= 24 ? 9U + (f.dlc - 12U) / 4U : f.dlc == 32 ? 13U : f.dlc == 48 ? 14U : 15U;
  bits.fast += push(code, 5);  // ESI and length
  for (unsigned i = 0; i < f.dlc; ++i) bits.fast += push(f.data[i], 8);
  if (ends_in_run) --bits.fast;  // the first stuff bit with a fixed place is in its stead
  if (switches == 0) return {bits.slow + bits.fast, 0};
  return bits;
}

/// Time of a frame on the bus, with stuff bits and interframe space.
[[nodiscard]] constexpr std::int64_t frame_ns(const Frame& f) noexcept {
  return f.format == Format::kClassic ? bits_to_ns(frame_bits(f)) : fd_bits(f).ns();
}

}  // namespace ligature::can
