#pragma once
// A deadline that may be set or not set. The simulated device takes time as an argument everywhere, so that tests
// control it.

#include <chrono>

namespace ligature::sim {

using Time = std::chrono::nanoseconds;  ///< since any fixed origin; the real program uses CLOCK_MONOTONIC
inline constexpr Time kNever = Time::max();

class Deadline {
 public:
  void arm(Time at) noexcept { at_ = at; }
  void disarm() noexcept { at_ = kNever; }
  [[nodiscard]] bool is_over(Time now) const noexcept { return now >= at_; }
  [[nodiscard]] Time at() const noexcept { return at_; }

 private:
  Time at_ = kNever;
};

}  // namespace ligature::sim
