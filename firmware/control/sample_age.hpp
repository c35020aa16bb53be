#pragma once
// Decides what a missing or late sample of a hand means. All code that depends on the age of samples uses SampleAge.

#include <cstdint>

#include "firmware/rt/rig_io.hpp"

namespace ligature::control {

/// Tells whether a reading is a new sample or the last one again, and in which period it was taken, even after lost
/// periods. It uses the age that the drives give with a reading (rt::HandReading::age_ticks), in executed periods: 0
/// for a set of samples of this period, and 1 more in each executed period in which no newer set has come.
class SampleAge {
 public:
  /// Call once in each tick. @param last_tick the period executed before this one
  void look(const rt::HandReading& reading, std::int64_t tick, std::int64_t last_tick) noexcept {
    const bool again = reading.age_ticks == last_age_ + 1;
    last_age_ = reading.age_ticks;
    tick_ = tick;
    fresh_ = false;
    if (!reading.valid) return;
    const std::int64_t taken = reading.age_ticks == 0 ? tick : last_tick - (reading.age_ticks - 1);
    fresh_ = taken_ < 0 || (!again && taken > taken_);
    if (fresh_) taken_ = taken;
  }
  /// Whether this tick brought a new sample, possibly a late one.
  [[nodiscard]] bool is_fresh() const noexcept { return fresh_; }
  /// Period in which the newest sample was taken; negative: none has come yet.
  [[nodiscard]] std::int64_t taken() const noexcept { return taken_; }
  /// Age of the newest sample in periods, including lost periods; 0 before the first sample.
  [[nodiscard]] std::int64_t ticks() const noexcept { return taken_ < 0 ? 0 : tick_ - taken_; }
  /// Whether the newest sample was taken in this period.
  [[nodiscard]] bool is_of_this_period() const noexcept { return taken_ >= 0 && ticks() == 0; }
  /// Whether the newest sample is as old as the watchdog allows: then it must not be used any more.
  [[nodiscard]] bool is_too_old(std::int32_t watchdog_ticks) const noexcept { return ticks() >= watchdog_ticks; }

 private:
  std::int64_t tick_ = 0, taken_ = -1;
  std::int32_t last_age_ = 0;
  bool fresh_ = false;
};

}  // namespace ligature::control
