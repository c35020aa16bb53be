#pragma once
// Time that the frames of one hand take on its bus in a period, and the time that is left for the loop and the physics.

#include <algorithm>
#include <chrono>

#include "firmware/rt/period.hpp"

namespace ligature::rt {

/// The hand's drives state these times (firmware/platform/hand_drives.hpp), because the times depend on the drives'
/// protocol. Each hand has its own bus.
struct BusTime {
  /// Time from the request for samples to the last bit of all samples. earliest: without stuff bits; latest: with the
  /// most possible
  std::chrono::nanoseconds samples_earliest{}, samples_latest{};
  /// Longest time that the frames with the torques take; the loop sends them after the samples have come, and they must
  /// be transmitted before the next request for samples
  std::chrono::nanoseconds torques_latest{};

  /// Time left for the loop's computing; with more, torques would be late.
  [[nodiscard]] constexpr std::chrono::nanoseconds most_work() const noexcept {
    return kPeriod - samples_latest - torques_latest;
  }
  /// The longest time that the loop may wait for samples after it woke up, so that the torques are still in time.
  [[nodiscard]] constexpr std::chrono::nanoseconds longest_wait() const noexcept {
    constexpr std::chrono::nanoseconds kControlLaw = std::chrono::microseconds(35);
    return kPeriod - torques_latest - kControlLaw;
  }
  friend constexpr bool operator==(const BusTime&, const BusTime&) = default;
};

/// Deadline of the physics tick: before the next samples can be complete. Their arrival time is predicted from the
/// earliest recent one, because the number of stuff bits changes little between periods. Samples that come earlier than
/// the bus can carry them are left out: they were sent late, for another period, and say nothing about the next one.
class ThreadDeadline {
 public:
  static constexpr std::chrono::nanoseconds kMargin = std::chrono::microseconds(25);
  /// Growth of the stored earliest time per period, so that old observations are forgotten
  static constexpr std::chrono::nanoseconds kForgets = std::chrono::nanoseconds(20);

  explicit ThreadDeadline(const BusTime& bus) noexcept : bus_(bus), earliest_(bus.samples_latest) {}

  /// Records that the samples were complete this long after the wake-up.
  void note(std::chrono::nanoseconds sampled) noexcept {
    earliest_ = std::min(earliest_ + kForgets, bus_.samples_latest);
    if (sampled >= bus_.samples_earliest) earliest_ = std::min(earliest_, sampled);
  }
  /// Deadline of the physics tick that ends before the samples of the period starting at `next_wake`.
  [[nodiscard]] std::chrono::nanoseconds before(std::chrono::nanoseconds next_wake) const noexcept {
    return next_wake + earliest_ - kMargin;
  }

 private:
  BusTime bus_;
  std::chrono::nanoseconds earliest_;
};

}  // namespace ligature::rt
