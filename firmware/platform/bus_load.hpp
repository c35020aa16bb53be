#pragma once
// How much of a period a CAN bus is busy.

#include <utility>

#include "firmware/rt/period.hpp"
#include "protocol/can/fd_time.hpp"

namespace ligature::platform {

/// Adds up the times of all frames of a period.
class BusLoad {
 public:
  void add(const can::Frame& frame) noexcept { busy_ns_ += can::frame_ns(frame); }
  void begin_period() noexcept { busy_ns_of_last_period_ = std::exchange(busy_ns_, 0); }
  /// Share of the last whole period, 0 to 1.
  [[nodiscard]] float of_last_period() const noexcept {
    return static_cast<float>(busy_ns_of_last_period_) / static_cast<float>(rt::kPeriod.count());
  }

 private:
  std::int64_t busy_ns_ = 0, busy_ns_of_last_period_ = 0;
};

}  // namespace ligature::platform
