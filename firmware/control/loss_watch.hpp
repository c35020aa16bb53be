#pragma once
// A bus that is bad and not dead: so many frames are lost that what is felt is no longer the thread.

#include <algorithm>
#include <array>
#include <cstdint>

#include "firmware/rt/rig_io.hpp"

namespace ligature::control {

/// Counts what one hand's bus loses, each way for itself: samples that did not come, and torques of which a drive says
/// that it makes an older one for want of an RPDO. A loss adds kLost to a count, what came takes kCame from it, and no
/// count is below 0. So losses of more than a third, kCame / (kCame + kLost), reach the limit sooner or later, and a
/// share well below that never does. Up to a third forces are told truly (docs/haptics.md): that is 12 % of the frames,
/// three of which make a sample.
/// A silence belongs to another fault (joint messages too old), which must come first: the limit is three times the
/// watchdog's ticks, since each tick of silence adds two. O(1).
class LossWatch {
 public:
  static constexpr int kLost = 2, kCame = 1;
  static constexpr int kMost = 60;  ///< with the usual watchdog of 20 ticks: 30 losses with nothing between them

  explicit LossWatch(std::int32_t watchdog_ticks = 20) noexcept : most_(std::max(kMost, 3 * watchdog_ticks)) {}

  /// This tick's reading.
  void look(const rt::HandReading& reading) noexcept {
    const bool fresh = reading.valid && reading.age_ticks != last_age_ + 1;
    last_age_ = reading.age_ticks;
    count(samples_, !fresh);
    if (!fresh) return;  // tells nothing new of the other way
    count(torques_, std::ranges::any_of(reading.torque_held, [](int held) { return held > 0; }));
  }
  void forget() noexcept { samples_ = torques_ = 0; }
  [[nodiscard]] bool is_lossy() const noexcept { return samples_ >= most_ || torques_ >= most_; }

 private:
  void count(int& losses, bool lost) const noexcept { losses = std::clamp(losses + (lost ? kLost : -kCame), 0, most_); }

  int most_;
  std::int32_t last_age_ = 0;
  int samples_ = 0, torques_ = 0;
};

}  // namespace ligature::control
