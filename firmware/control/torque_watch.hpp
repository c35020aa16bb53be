#pragma once
// Detects a drive that reports a torque which it was not asked for.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "firmware/rt/rig_io.hpp"
#include "protocol/device/device.hpp"

namespace ligature::control {

/// Compares the torques that one hand's drives report with all torques that the commands allow. A drive makes the
/// commanded torque, or less (it protects its winding, or is off), or an earlier one if an RPDO is missing, but for no
/// longer than its watchdog time. So a joint's reported torque must lie between zero and the extremes of what was sent
/// to the joint within the watchdog time plus kWay ticks. The extremes are stored in kBlocks blocks of equal length, in
/// all 28 to 32 ticks with a watchdog of 20.
/// The tolerance is in the device record. One sample outside is overshoot or noise; kStrange samples in a row are a
/// fault. A drive whose message has no torque reports a deviation by a statusword bit instead. O(kBlocks), no
/// allocation.
class TorqueWatch {
 public:
  static constexpr int kStrange = 2;  ///< consecutive samples
  static constexpr int kWay = 4;      ///< ticks for the way of a torque: sent, acting, reported, message late

  TorqueWatch(const device::Device& device, std::int32_t watchdog_ticks) noexcept
      : tolerance_Nm_(device.torque_tolerance_permille * device.Nm_per_permille()),
        block_ticks_((watchdog_ticks + kWay) / static_cast<std::int32_t>(kBlocks - 1) + 1) {}

  /// Checks this tick's reading; call before sent() of this tick. @param fresh whether the reading is a new sample
  /// (SampleAge)
  void look(const rt::HandReading& reading, bool fresh) noexcept {
    if (!fresh) return;
    joint_ = strange_joint(reading);
    strange_ = joint_ >= 0 ? std::min(strange_ + 1, kStrange) : 0;
  }
  void sent(const std::array<double, rt::kJoints>& torque_Nm) noexcept {
    if (++ticks_ >= block_ticks_) {
      ticks_ = 0;
      newest_ = (newest_ + 1) % kBlocks;
      blocks_[newest_] = {};
    }
    for (std::size_t j = 0; j < rt::kJoints; ++j) {
      Range& r = blocks_[newest_][j];
      r.low_Nm = std::min(r.low_Nm, torque_Nm[j]);
      r.high_Nm = std::max(r.high_Nm, torque_Nm[j]);
    }
  }
  [[nodiscard]] bool is_astray() const noexcept { return strange_ >= kStrange; }
  /// First joint whose torque was outside in the last sample; -1: none.
  [[nodiscard]] std::int8_t joint() const noexcept { return joint_; }

 private:
  static constexpr std::size_t kBlocks = 8;
  struct Range {
    double low_Nm = 0.0, high_Nm = 0.0;
  };

  /// First joint whose drive reports a deviation, or a torque outside the extremes; -1: none.
  [[nodiscard]] std::int8_t strange_joint(const rt::HandReading& reading) const noexcept {
    for (std::size_t j = 0; j < rt::kJoints; ++j) {
      const double told_Nm = std::isfinite(reading.measured_Nm[j]) ? reading.measured_Nm[j] : reading.torque_Nm[j];
      Range may;
      for (const auto& block : blocks_) {
        may.low_Nm = std::min(may.low_Nm, block[j].low_Nm);
        may.high_Nm = std::max(may.high_Nm, block[j].high_Nm);
      }
      // A joint whose message has no torque is not a number here, and is within the extremes
      const bool outside = told_Nm < may.low_Nm - tolerance_Nm_ || told_Nm > may.high_Nm + tolerance_Nm_;
      if (outside || reading.torque_astray[j]) return static_cast<std::int8_t>(j);
    }
    return -1;
  }

  double tolerance_Nm_;
  std::int32_t block_ticks_, ticks_ = 0;
  std::size_t newest_ = 0;
  std::array<std::array<Range, rt::kJoints>, kBlocks> blocks_{};  // ring; the newest block is still being filled
  int strange_ = 0;
  std::int8_t joint_ = -1;
};

}  // namespace ligature::control
