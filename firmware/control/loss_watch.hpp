#pragma once
// Detects a bus that loses so many frames that the force at the hand no longer follows the suture.

#include <algorithm>
#include <array>
#include <cstdint>

#include "firmware/rt/rig_io.hpp"

namespace ligature::control {

/// Counts one hand's lost frames with a counter for each direction: samples that did not come, and torques that a drive
/// repeated because an RPDO was missing. A lost frame adds kLost to its counter, a frame that came subtracts kCame; a
/// counter never falls below 0. So a loss rate above kCame / (kCame + kLost) = 1/3 reaches the limit eventually, and a
/// rate well below never does. Forces are still correct while up to 1/3 of the samples are lost, that is 12 % of the
/// frames, because a sample consists of three (docs/haptics.md). Complete silence must raise the fault "joint messages
/// too old" first. A silent tick adds 2, so the limit is three times the watchdog's ticks. O(1).
class LossWatch {
 public:
  static constexpr int kLost = 2, kCame = 1;
  static constexpr int kMost = 60;  ///< with the usual watchdog of 20 ticks: 30 losses in a row

  explicit LossWatch(std::int32_t watchdog_ticks = 20) noexcept : most_(std::max(kMost, 3 * watchdog_ticks)) {}

  /// Counts the losses in this tick's reading. @param fresh whether the reading is a new sample (SampleAge)
  void look(const rt::HandReading& reading, bool fresh) noexcept {
    count(samples_, !fresh);
    if (!fresh) return;  // without a new sample nothing is known about the torques
    count(torques_, std::ranges::any_of(reading.torque_held, [](int held) { return held > 0; }));
  }
  void forget() noexcept { samples_ = torques_ = 0; }
  [[nodiscard]] bool is_lossy() const noexcept { return samples_ >= most_ || torques_ >= most_; }

 private:
  void count(int& losses, bool lost) const noexcept { losses = std::clamp(losses + (lost ? kLost : -kCame), 0, most_); }

  int most_;
  int samples_ = 0, torques_ = 0;
};

}  // namespace ligature::control
