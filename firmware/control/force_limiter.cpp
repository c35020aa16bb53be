#include "firmware/control/force_limiter.hpp"

#include <algorithm>

namespace ligature::control {

using physics::Vec3;

ForceLimiter::ForceLimiter(const device::Device& d, double max_force_N, double period_s) noexcept
    : device_peak_N_(d.peak_force_N),
      step_N_(d.force_step_N),
      slew_N_per_s_(d.force_slew_N_per_s),
      period_s_(period_s),
      allowance_N_(d.force_step_N),
      thermal_(d.peak_force_N, d.continuous_force_N, d.thermal_time_s, period_s) {
  set_peak(max_force_N);
}

void ForceLimiter::set_peak(double max_force_N) noexcept { peak_N_ = std::min(max_force_N, device_peak_N_); }

Vec3 ForceLimiter::limit(const Vec3& wish_N, const MostByJoints& most) noexcept {
  codes_ = 0;
  const double warm_N = std::min(thermal_.cap(), most.by_heat_N), cap_N = std::min(peak_N_, warm_N);
  const LimitedForce capped = saturate(wish_N, std::min(cap_N, most.in_any_pose_N));
  if (capped.limited)
    codes_ |= most.in_any_pose_N < cap_N ? rt::kTorqueLimit : warm_N < peak_N_ ? rt::kContinuousLimit : rt::kPeakLimit;

  allowance_N_ = std::min(step_N_, allowance_N_ + slew_N_per_s_ * period_s_);
  const Vec3 change = capped.f_N - before_N_;
  const double size_N = change.norm();
  if (size_N <= allowance_N_) return capped.f_N;
  codes_ |= allowance_N_ < step_N_ ? rt::kSlewLimit : rt::kStepLimit;
  constexpr double kRounding = 1.0 - 4.0 * std::numeric_limits<double>::epsilon();
  // On the line between two allowed forces, so allowed
  return before_N_ + change * (allowance_N_ * kRounding / size_N);
}

void ForceLimiter::sent(const Vec3& f_N, std::int64_t periods) noexcept {
  allowance_N_ = std::max(0.0, allowance_N_ - (f_N - before_N_).norm());
  before_N_ = f_N;
  thermal_.sent(f_N.norm(), periods);
}

}  // namespace ligature::control
