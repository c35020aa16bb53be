#pragma once
// Velocity from quantised positions, by a window whose length adapts to the motion.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace ligature::control {

/// First-order adaptive window (Janabi-Sharifi, Hayward, Chen: IEEE Trans. Control Syst. Technol. 8(6), 2000), for the
/// positions x of one joint. Takes the largest k <= kWindow for which the straight line through x[n] (newest sample)
/// and x[n-k] passes every sample between them within the encoder's uncertainty d. The velocity is the slope of the
/// least-squares line through these k+1 samples, taken at the times t_i:
///   v = sum (t_i - t_mean)(x_i - x_mean) / sum (t_i - t_mean)^2
/// At rest and in slow motion the window is long and the quantisation noise small. In fast changes the window is short,
/// and so is the lag of k T / 2 (T: period). docs/measurements/haptics.md compares this with a low-pass filter. Samples
/// may be missing, because their times are used. O(kWindow), no allocation.
class WindowVelocity {
 public:
  static constexpr std::size_t kWindow = 16;

  /// @param quantum encoder step; it is also the uncertainty d, because ends and inner samples may each be off by half
  /// a step
  WindowVelocity(double period_s, double quantum) noexcept : period_s_(period_s), d_(quantum * (1.0 + 1e-9)) {}

  /// @param periods whole periods since the last sample; a sample with 0 or less is ignored, unless it is the first one
  void add(double x, std::int64_t periods) noexcept {
    if (count_ > 0 && periods <= 0) return;
    if (periods > kForget) count_ = 0;  // gap too long: start a new window
    for (std::size_t i = kWindow; i > 0; --i) x_[i] = x_[i - 1], age_[i] = age_[i - 1] + static_cast<double>(periods);
    x_[0] = x;
    age_[0] = 0.0;
    if (count_ <= kWindow) ++count_;
    k_ = longest_straight();
    velocity_ = k_ == 0 ? 0.0 : -slope(k_) / period_s_;
  }

  /// Call if the time of the last sample is unknown: the velocity becomes 0, and the window restarts at that sample.
  void doubt_last_time() noexcept { count_ = 1, k_ = 0, velocity_ = 0.0; }

  [[nodiscard]] double velocity_per_s() const noexcept { return velocity_; }
  [[nodiscard]] std::size_t window() const noexcept { return k_; }

 private:
  static constexpr std::int64_t kForget = 32;

  /// Largest k for which the line through samples 0 and k stays within d of all samples between. Each sample between
  /// restricts the line's slope to an interval, and the slope must lie in all these intervals.
  [[nodiscard]] std::size_t longest_straight() const noexcept {
    double least = -1e300, most = 1e300;
    for (std::size_t k = 1; k < count_; ++k) {
      const double change = x_[k] - x_[0], per_age = change / age_[k];
      if (per_age < least || per_age > most) return k - 1;
      least = std::max(least, (change - d_) / age_[k]);
      most = std::min(most, (change + d_) / age_[k]);
    }
    return count_ > 0 ? count_ - 1 : 0;
  }

  /// Least-squares slope of x over age, for samples 0 .. k.
  [[nodiscard]] double slope(std::size_t k) const noexcept {
    double age = 0.0, x = 0.0;
    for (std::size_t i = 0; i <= k; ++i) age += age_[i], x += x_[i] - x_[0];
    const double n = static_cast<double>(k + 1);
    double above = 0.0, below = 0.0;
    for (std::size_t i = 0; i <= k; ++i) {
      const double a = age_[i] - age / n;
      above += a * (x_[i] - x_[0] - x / n);
      below += a * a;
    }
    return above / below;
  }

  double period_s_, d_;
  std::array<double, kWindow + 1> x_{}, age_{};  // newest first; age in periods
  std::size_t count_ = 0, k_ = 0;
  double velocity_ = 0.0;
};

}  // namespace ligature::control
