#pragma once
// What the classic CAN bus at 1 Mbit/s does with a period, and what that leaves.

#include <algorithm>
#include <chrono>

#include "firmware/rt/period.hpp"

namespace ligature::rt {

/// From SYNC to the last bit of a hand's three joint messages: 47 bits and three times 111 when none is stuffed, and
/// with all the stuff bits that there can be. The two hands have a bus each.
inline constexpr std::chrono::nanoseconds kSamplesEarliest = std::chrono::microseconds(380);
inline constexpr std::chrono::nanoseconds kSamplesLatest = std::chrono::microseconds(460);
/// Three torque messages of a hand at the most: they must have passed before the next SYNC.
inline constexpr std::chrono::nanoseconds kTorquesLatest = std::chrono::microseconds(285);

/// What the bus leaves the loop for computing: with more, torques would come after the SYNC at which they are to act.
inline constexpr std::chrono::nanoseconds kMostWork = kPeriod - kSamplesLatest - kTorquesLatest;

/// When the thread's tick must have ended: before the next samples can be in. When these come is what the last ones did,
/// the earliest of them, as the number of stuff bits changes little from period to period; never beyond what the bus can
/// do.
class ThreadDeadline {
 public:
  static constexpr std::chrono::nanoseconds kMargin = std::chrono::microseconds(25);
  static constexpr std::chrono::nanoseconds kForgets = std::chrono::nanoseconds(20);  ///< of the earliest, a period

  /// Samples were in so long after the wake-up.
  void note(std::chrono::nanoseconds sampled) noexcept {
    earliest_ = std::clamp(std::min(earliest_ + kForgets, sampled), kSamplesEarliest, kSamplesLatest);
  }
  /// For the tick whose next period begins at `next_wake`.
  [[nodiscard]] std::chrono::nanoseconds before(std::chrono::nanoseconds next_wake) const noexcept {
    return next_wake + earliest_ - kMargin;
  }

 private:
  std::chrono::nanoseconds earliest_ = kSamplesLatest;
};

}  // namespace ligature::rt
