#pragma once
// Measures chatter, the rapid fluctuation of a force that otherwise changes slowly.

#include <algorithm>
#include <cmath>
#include <span>

namespace ligature::bench {

/// Residual of a force against a moving least-squares parabola.
struct Chatter {
  double rms_N = 0.0, mean_N = 0.0;
  int ticks = 0;  ///< ticks evaluated; 0: force never above the floor long enough
  [[nodiscard]] double share() const noexcept { return ticks > 0 ? rms_N / mean_N : 0.0; }
};

/// Evaluates every stretch of ticks in which the force stays above floor_N, with a parabola fitted to 51 ticks, or to
/// half the stretch if that is shorter. A parabola is used because a pull's force rises ever more steeply; about a
/// moving mean that rise alone would count as 2.4 % at 0.2 m/s. Stretches are kept apart because the force drops to
/// zero when an overhand's loop snaps over during the pull; a fit across the gap would count that jump as chatter. The
/// fitted value at the middle of 2 m + 1 ticks is the weighted sum with weights
///   3 (3 m^2 + 3 m - 1 - 5 k^2) / ((2 m - 1) (2 m + 1) (2 m + 3)), k = -m .. m [Savitzky & Golay 1964].
[[nodiscard]] inline Chatter chatter(std::span<const double> force_N, double floor_N) {
  constexpr int kHalf = 25, kLeast = 3;
  double squares = 0.0, sum = 0.0;
  Chatter c;
  const auto stretch = [&](std::span<const double> f) {
    const int n = static_cast<int>(f.size()), m = std::min(kHalf, n / 4);
    if (m < kLeast) return;
    const double norm = (2.0 * m - 1.0) * (2.0 * m + 1.0) * (2.0 * m + 3.0);
    for (int i = m; i + m < n; ++i) {
      double smooth = 0.0;
      for (int k = -m; k <= m; ++k)
        smooth += 3.0 * (3.0 * m * m + 3.0 * m - 1.0 - 5.0 * k * k) / norm * f[static_cast<std::size_t>(i + k)];
      squares += std::pow(f[static_cast<std::size_t>(i)] - smooth, 2);
      sum += f[static_cast<std::size_t>(i)];
      ++c.ticks;
    }
  };
  for (std::size_t begin = 0; begin < force_N.size();) {
    std::size_t end = begin;
    while (end < force_N.size() && force_N[end] > floor_N) ++end;
    stretch(force_N.subspan(begin, end - begin));
    begin = end + 1;
  }
  if (c.ticks > 0) c.rms_N = std::sqrt(squares / c.ticks), c.mean_N = sum / c.ticks;
  return c;
}

}  // namespace ligature::bench
