#pragma once
// Duration of a frame on the bus. Classic CAN, 11-bit identifier (ISO 11898-1): start bit, identifier, control field,
// data and CRC are 34 + 8 n bits (n data bytes) and are stuffed; CRC delimiter, acknowledge, end of frame and the 3
// bits of interframe space are 13 more. Stuffing adds at most floor((34 + 8 n - 1) / 4) bits. CAN FD: fd_time.hpp.

#include <cstdint>

#include "protocol/can/device_profile.hpp"
#include "protocol/can/remote.hpp"

namespace ligature::can {

inline constexpr unsigned kInterframeBits = 3;
inline constexpr unsigned kUnstuffedTailBits = 10 + kInterframeBits;

[[nodiscard]] constexpr unsigned stuffable_bits(unsigned dlc) noexcept { return 34 + 8 * dlc; }
[[nodiscard]] constexpr unsigned min_frame_bits(unsigned dlc) noexcept {
  return stuffable_bits(dlc) + kUnstuffedTailBits;
}
[[nodiscard]] constexpr unsigned max_frame_bits(unsigned dlc) noexcept {
  return min_frame_bits(dlc) + (stuffable_bits(dlc) - 1) / 4;
}

/// Stuffing: after five equal bits one opposite bit is inserted, which counts as the first of the next run.
class StuffRun {
 public:
  /// @return whether a bit is inserted after this one
  constexpr bool push(bool bit) noexcept {
    run_ = (run_ > 0 && bit == last_) ? run_ + 1 : 1;
    last_ = bit;
    if (run_ < 5) return false;
    last_ = !bit;
    run_ = 1;
    return true;
  }

 private:
  int run_ = 0;
  bool last_ = false;
};

/// Computes the CRC and counts stuff bits of a frame, bit by bit. CRC polynomial: x^15+x^14+x^10+x^8+x^7+x^4+x^3+1.
class StuffCounter {
 public:
  constexpr void push(bool bit) noexcept {
    const bool invert = bit != ((crc_ >> 14U) & 1U);
    crc_ = (crc_ << 1U) & 0x7FFFU;
    if (invert) crc_ ^= 0x4599U;
    stuff(bit);
  }
  constexpr void push(std::uint32_t value, int bits) noexcept {
    for (int i = bits - 1; i >= 0; --i) push(((value >> i) & 1U) != 0);
  }
  /// Appends the CRC to the frame. @return the number of stuff bits inserted.
  [[nodiscard]] constexpr unsigned finish() noexcept {
    const std::uint32_t crc = crc_;
    for (int i = 14; i >= 0; --i) stuff(((crc >> i) & 1U) != 0);
    return inserted_;
  }
  [[nodiscard]] constexpr std::uint32_t crc() const noexcept { return crc_; }

 private:
  constexpr void stuff(bool bit) noexcept { inserted_ += run_.push(bit) ? 1U : 0U; }

  std::uint32_t crc_ = 0;
  unsigned inserted_ = 0;
  StuffRun run_;
};

/// Exact number of bits of this classic frame on the wire, including stuff bits and interframe space. Takes about 0.3
/// us.
[[nodiscard]] constexpr unsigned frame_bits(const Frame& f) noexcept {
  StuffCounter counter;
  const unsigned bytes = is_remote(f) ? 0U : f.dlc;
  counter.push(false);  // start of frame
  counter.push(f.id & kMaxId, 11);
  counter.push(is_remote(f) ? 4U : 0U, 3);  // RTR, IDE, reserved: base format
  counter.push(f.dlc, 4);
  for (unsigned i = 0; i < bytes; ++i) counter.push(f.data[i], 8);
  return min_frame_bits(bytes) + counter.finish();
}

[[nodiscard]] constexpr std::int64_t bits_to_ns(unsigned bits) noexcept { return bits * profile::kBitTime_ns; }

/// All frames of one hand in one tick: SYNC, three 8-byte TPDOs, three 4-byte RPDOs.
inline constexpr unsigned kMinCycleBits = min_frame_bits(0) + 3 * min_frame_bits(8) + 3 * min_frame_bits(4);
inline constexpr unsigned kMaxCycleBits = max_frame_bits(0) + 3 * max_frame_bits(8) + 3 * max_frame_bits(4);
static_assert(kMinCycleBits == 617 && kMaxCycleBits == 745);  // 61.7 .. 74.5 % of a 1 ms period

}  // namespace ligature::can
