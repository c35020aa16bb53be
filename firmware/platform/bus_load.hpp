#pragma once
// How much of a period a CAN bus is busy.

#include <utility>

#include "firmware/rt/period.hpp"
#include "protocol/can/bit_time.hpp"

namespace ligature::platform {

/// Counts the bits of all frames of a period at 1 Mbit/s.
class BusLoad {
 public:
  void add(const can::Frame& frame) noexcept { bits_ += can::frame_bits(frame); }
  void begin_period() noexcept { bits_of_last_period_ = std::exchange(bits_, 0U); }
  /// Share of the last whole period, 0 to 1.
  [[nodiscard]] float of_last_period() const noexcept {
    return static_cast<float>(can::bits_to_ns(bits_of_last_period_)) / static_cast<float>(rt::kPeriod.count());
  }

 private:
  unsigned bits_ = 0, bits_of_last_period_ = 0;
};

}  // namespace ligature::platform
