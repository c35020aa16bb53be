#pragma once
// Thermal (I2t) limit: decides how long a motor may exceed its continuous force or torque.

#include <algorithm>
#include <cstdint>

namespace ligature::control {

/// Caps a force or torque x by an I2t model of the winding's heat:
///   dh/dt = ((x / continuous)^2 - h) / tau      h: temperature rise; 1 at `continuous` held for ever
/// When h reaches kHot, the cap falls from the peak to `continuous`; when h is below kCool, the cap rises again at the
/// same rate. The gap between kHot and kCool avoids a force that comes and goes.
/// The fall takes kFall_s, or less if h would otherwise exceed 1 + kMostOver: with r = peak / continuous, the mean of
/// (x / continuous)^2 during a linear fall is (r^2 + r + 1) / 3, so in a time t, h rises by less than ((r^2 + r + 1) /
/// 3 - 1) t / tau. So this cap acts before a drive that limits at 1.2 times `continuous` (h = 1.44). O(1).
class ThermalCap {
 public:
  static constexpr double kFall_s = 0.5;
  static constexpr double kHot = 1.0, kCool = 0.7, kMostOver = 0.35;

  ThermalCap(double peak, double continuous, double tau_s, double period_s) noexcept
      : peak_(std::max(peak, continuous)), continuous_(continuous), tau_s_(tau_s), period_s_(period_s), cap_(peak_) {
    const double r = peak_ / continuous_, rise = (r * r + r + 1.0) / 3.0 - 1.0;
    fall_s_ = std::min(kFall_s, kMostOver * tau_s_ / std::max(rise, 1e-9));
  }

  /// Call once per tick. @param size the force or torque that is sent now. @param periods since the last call; its
  /// value acted in all of them.
  void sent(double size, std::int64_t periods = 1) noexcept {
    const double load = sent_ / continuous_,
                 time_s = period_s_ * static_cast<double>(std::max<std::int64_t>(periods, 1));
    heat_ += (load * load - heat_) * std::min(1.0, time_s / tau_s_);
    sent_ = size;
    if (heat_ >= kHot) hot_ = true;
    if (heat_ < kCool) hot_ = false;
    const double by = (peak_ - continuous_) * time_s / fall_s_;
    cap_ = hot_ ? std::max(continuous_, cap_ - by) : std::min(peak_, cap_ + by);
  }

  [[nodiscard]] double heat() const noexcept { return heat_; }
  [[nodiscard]] double cap() const noexcept { return cap_; }
  [[nodiscard]] bool is_full() const noexcept { return cap_ == peak_; }

 private:
  double peak_, continuous_, tau_s_, period_s_, cap_, fall_s_ = kFall_s;
  double heat_ = 0.0, sent_ = 0.0;
  bool hot_ = false;
};

}  // namespace ligature::control
