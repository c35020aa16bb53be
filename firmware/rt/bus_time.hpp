#pragma once
// Time budget of a period on a classic CAN bus at 1 Mbit/s.

#include <algorithm>
#include <chrono>

#include "firmware/rt/period.hpp"

namespace ligature::rt {

/// Time from SYNC to the last bit of a hand's three joint messages: 47 + 3 x 111 bits without stuff bits, and with the
/// largest number of stuff bits. Each hand has its own bus.
inline constexpr std::chrono::nanoseconds kSamplesEarliest = std::chrono::microseconds(380);
inline constexpr std::chrono::nanoseconds kSamplesLatest = std::chrono::microseconds(460);
/// Longest time of a hand's three torque messages, which must be sent before the next SYNC.
inline constexpr std::chrono::nanoseconds kTorquesLatest = std::chrono::microseconds(285);

/// Time left for the loop's computing; with more, torques would miss the SYNC at which they are to act.
inline constexpr std::chrono::nanoseconds kMostWork = kPeriod - kSamplesLatest - kTorquesLatest;

/// Deadline of the physics tick: before the next samples can be complete. Their arrival time is predicted from the
/// earliest recent one, because the number of stuff bits changes little between periods; it is limited to what the bus
/// can do.
class ThreadDeadline {
 public:
  static constexpr std::chrono::nanoseconds kMargin = std::chrono::microseconds(25);
  /// Growth of the stored earliest time per period, so that old observations are forgotten
  static constexpr std::chrono::nanoseconds kForgets = std::chrono::nanoseconds(20);

  /// Records that the samples were complete this long after the wake-up.
  void note(std::chrono::nanoseconds sampled) noexcept {
    earliest_ = std::clamp(std::min(earliest_ + kForgets, sampled), kSamplesEarliest, kSamplesLatest);
  }
  /// Deadline of the physics tick that ends before the samples of the period starting at `next_wake`.
  [[nodiscard]] std::chrono::nanoseconds before(std::chrono::nanoseconds next_wake) const noexcept {
    return next_wake + earliest_ - kMargin;
  }

 private:
  std::chrono::nanoseconds earliest_ = kSamplesLatest;
};

}  // namespace ligature::rt
