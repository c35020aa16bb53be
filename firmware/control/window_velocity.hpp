#pragma once
// Velocity out of quantised positions: as long a window as the motion lets be straight, and no longer.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace ligature::control {

/// First-order adaptive window (Janabi-Sharifi, Hayward, Chen: IEEE Trans. Control Syst. Technol. 8(6), 2000), one
/// joint. Of the samples x[n], x[n-1] .. x[n-k] it takes the most, k <= kWindow, for which the straight line through
/// the two ends passes every sample between them within the encoder's uncertainty d; the slope of the least-squares
/// line through these k+1 samples is the velocity:
///   v = sum (t_i - t_mean)(x_i - x_mean) / sum (t_i - t_mean)^2
/// At rest and in slow motion the window is long and the counts' noise small; in fast changes it is short and so is the
/// lag, k T / 2. Figures against the former low-pass: docs/haptics.md, held by the tests WindowVelocity.*.
/// Samples that never came leave a gap in time, not in the line. O(kWindow), no allocation.
class WindowVelocity {
 public:
  static constexpr std::size_t kWindow = 16;

  /// @param quantum step of the positions; d = 1 quantum, for both ends may be off by half of it and so may the middle.
  WindowVelocity(double period_s, double quantum) noexcept : period_s_(period_s), d_(quantum * (1.0 + 1e-9)) {}

  /// @param periods whole periods since the last sample; <= 0 changes nothing, except that the first sample seeds.
  void add(double x, std::int64_t periods) noexcept {
    if (count_ > 0 && periods <= 0) return;
    if (periods > kForget) count_ = 0;  // a line over so long a gap says nothing
    for (std::size_t i = kWindow; i > 0; --i) x_[i] = x_[i - 1], age_[i] = age_[i - 1] + static_cast<double>(periods);
    x_[0] = x;
    age_[0] = 0.0;
    if (count_ <= kWindow) ++count_;
    k_ = longest_straight();
    velocity_ = k_ == 0 ? 0.0 : -slope(k_) / period_s_;
  }

  /// The time of the last sample is not known: it says where, and not how fast; the window begins with it.
  void doubt_last_time() noexcept { count_ = 1, k_ = 0, velocity_ = 0.0; }

  [[nodiscard]] double velocity_per_s() const noexcept { return velocity_; }
  [[nodiscard]] std::size_t window() const noexcept { return k_; }

 private:
  static constexpr std::int64_t kForget = 32;

  /// k: the largest for which the line through the ends stays within d of what lies between. Each sample bounds the
  /// slope of the lines that pass it; a longer line has to keep within all of these bounds.
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

  /// Of x over age, least squares, of samples 0 .. k.
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
