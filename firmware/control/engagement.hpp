#pragma once
// Gain of one hand: fades the computed force in and out, so that it never starts with a jump.

#include "firmware/control/motion.hpp"
#include "firmware/rt/period.hpp"

namespace ligature::control {

/// Gain of one hand, 0 .. 1. While force is wanted (armed and dead-man pressed), the gain rises to 1 in 0.5 s;
/// otherwise it falls to 0 in 50 ms. Both follow a jerk-limited curve (motion.hpp). The rise begins only after
/// kCalmTicks in which the hand was still and the force small. Assumes periods of 1 ms. O(1).
class Engagement {
 public:
  static constexpr int kCalmTicks = 20;
  /// Below this speed of the device's tip the hand counts as still; the velocity estimate has 0.003 m/s of noise
  static constexpr double kStill_m_per_s = 0.05;
  static constexpr double kSmallForce_N = 0.5;  ///< force that the hand would get at gain 1; 15 % of the peak
  static constexpr int kRiseTicks = 500;
  static constexpr int kFallTicks = 50;

  void tick(bool wanted, double speed_m_per_s, double force_N) noexcept {
    if (!wanted) {
      calm_ticks_ = 0;
      ramp_.step(0.0, kFallTicks * rt::kPeriod_s);
      return;
    }
    if (gain() == 0.0 && calm_ticks_ < kCalmTicks) {
      const bool calm = speed_m_per_s < kStill_m_per_s && force_N < kSmallForce_N;
      calm_ticks_ = calm ? calm_ticks_ + 1 : 0;
      return;
    }
    ramp_.step(1.0, kRiseTicks * rt::kPeriod_s);
  }

  void drop() noexcept {
    ramp_.settle(0.0);
    calm_ticks_ = 0;
  }

  [[nodiscard]] double gain() const noexcept { return ramp_.value(); }

 private:
  Ramp ramp_{rt::kPeriod_s};
  int calm_ticks_ = 0;
};

}  // namespace ligature::control
