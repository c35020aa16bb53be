#pragma once
// Velocity out of quantised positions.

#include <cstdint>

#include "firmware/physics/types.hpp"

namespace ligature::control {

/// Backward difference through a first-order low-pass:
///   v[n] = v[n-1] + a ((p[n] - p[n-1]) / T - v[n-1]),   a = 0.2, T = 1 ms  (corner about 35 Hz)
/// Noise: positions rounded to a step d carry an error of deviation d/sqrt(12); the velocity's is
/// d/(T sqrt(12)) * a sqrt(2/(2-a)) = 0.061 d/T: 3 mm/s at the tip for a count of 0.051 mm, against 21 mm/s unfiltered.
/// Lag: a ramp is followed (1-a)/a T = 4 ms behind. Both are held by tests VelocityFilter.*.
/// When samples are missing, the difference runs over the time that really passed and one filter step is made for
/// each period of it, so that the lag stays the same. O(1) for up to kMaxSteps missing periods.
class VelocityFilter {
 public:
  static constexpr double kGain = 0.2;
  static constexpr std::int64_t kMaxSteps = 32;  ///< 0.8^32 < 0.1 %: beyond it the past is forgotten

  explicit VelocityFilter(double period_s) noexcept : period_s_(period_s) {}

  /// @param periods whole periods since the last sample; ≤ 0 changes nothing. The first sample gives zero velocity.
  void add(const physics::Vec3& p_m, std::int64_t periods) noexcept {
    if (!seeded_) {
      seeded_ = true;
      p_m_ = p_m;
    }
    if (periods <= 0) return;
    const physics::Vec3 v = (p_m - p_m_) / (static_cast<double>(periods) * period_s_);
    for (std::int64_t i = 0; i < periods && i < kMaxSteps; ++i) v_m_per_s_ += kGain * (v - v_m_per_s_);
    p_m_ = p_m;
  }

  [[nodiscard]] const physics::Vec3& velocity_m_per_s() const noexcept { return v_m_per_s_; }

 private:
  double period_s_;
  bool seeded_ = false;
  physics::Vec3 p_m_ = physics::Vec3::Zero();
  physics::Vec3 v_m_per_s_ = physics::Vec3::Zero();
};

}  // namespace ligature::control
