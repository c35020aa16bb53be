#pragma once
// Torque that nobody asked for.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "firmware/rt/rig_io.hpp"
#include "protocol/device/device.hpp"

namespace ligature::control {

/// What one hand's drives say that they make, against what may come of all that was sent to them. A drive makes what
/// it was sent, or less (a guarded winding, a drive that is off), or for want of an RPDO what it made before, but for
/// no longer than the watchdog lets it. So a torque told must lie between zero and what was sent to that joint within
/// the watchdog's time and kWay ticks more for the way there and back. That is remembered in kBlocks of equal length:
/// 28 to 32 ticks with a watchdog of 20. The device record says by how much a drive may miss; one sample beyond is an
/// overshoot or noise, kStrange in a row are not. A joint whose message has no room for a torque tells by a bit of its
/// statusword. O(kBlocks), no allocation.
class TorqueWatch {
 public:
  static constexpr int kStrange = 2;  ///< samples in a row
  static constexpr int kWay = 4;      ///< ticks: sent, acting, told, a late message

  TorqueWatch(const device::Device& device, std::int32_t watchdog_ticks) noexcept
      : tolerance_Nm_(device.torque_tolerance_permille * device.Nm_per_permille()),
        block_ticks_((watchdog_ticks + kWay) / static_cast<std::int32_t>(kBlocks - 1) + 1) {}

  /// This tick's reading, before sent() of this tick.
  void look(const rt::HandReading& reading) noexcept {
    const bool fresh = reading.valid && reading.age_ticks != last_age_ + 1;
    last_age_ = reading.age_ticks;
    if (!fresh) return;
    strange_ = is_strange(reading) ? std::min(strange_ + 1, kStrange) : 0;
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

 private:
  static constexpr std::size_t kBlocks = 8;
  struct Range {
    double low_Nm = 0.0, high_Nm = 0.0;
  };

  [[nodiscard]] bool is_strange(const rt::HandReading& reading) const noexcept {
    bool strange = reading.torque_astray;
    for (std::size_t j = 0; j < rt::kJoints; ++j) {
      const double told_Nm = reading.torque_Nm[j];
      if (!std::isfinite(told_Nm)) continue;  // no room for it in the message
      Range may;
      for (const auto& block : blocks_) {
        may.low_Nm = std::min(may.low_Nm, block[j].low_Nm);
        may.high_Nm = std::max(may.high_Nm, block[j].high_Nm);
      }
      strange = strange || told_Nm < may.low_Nm - tolerance_Nm_ || told_Nm > may.high_Nm + tolerance_Nm_;
    }
    return strange;
  }

  double tolerance_Nm_;
  std::int32_t block_ticks_, ticks_ = 0, last_age_ = 0;
  std::size_t newest_ = 0;
  std::array<std::array<Range, rt::kJoints>, kBlocks> blocks_{};  // the newest is not full
  int strange_ = 0;
};

}  // namespace ligature::control
