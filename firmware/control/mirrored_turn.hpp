#pragma once
// How much a joint's turn looks like an encoder that begins to count backwards.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace ligature::control {

/// From the sample x0 on, an encoder that was reversed tells 2 x0 - x. Told back, the two halves are one smooth curve.
/// Those of a hand that turns with the acceleration a at speed u are not: it takes 2 u / a for it, and they lie a step
/// of u^2 / a apart. Looked for is a turn whose halves, the second one told back, are one parabola but for what counts
/// hide. A step of two counts is never taken for one: a hand of up to u^2 / 2 is
/// honest, at 1.4 counts a period (70 mm/s at an Omni's tip) one of 49 m/s2. A slow hand turns with less, over more
/// samples: the slower, the longer the halves that are looked at. How often the sharpest hands are suspected, and what
/// is missed: docs/encoder-watch.md. All O(kLongest), no allocation.
class MirroredTurn {
 public:
  struct Look {
    std::size_t half;  ///< samples of a half
    double moving;     ///< least speed at the turn, counts a period
    double rough;      ///< rms, counts; counts alone make 0.29
    bool alone;        ///< else another joint has to move on as before
  };
  static constexpr std::array<Look, 4> kLooks{
      {{6, 1.4, 0.4, true}, {12, 0.85, 0.4, true}, {24, 0.6, 0.4, true}, {24, 0.44, 0.36, false}}};
  static constexpr std::size_t kLongest = 24;

  /// Speed at the turn, counts a period, of samples x(2 half - 1) .. x(0), the newest last; x(half) is the last true
  /// one. 0: it is no turn, or no such one.
  template <class Sample>
  [[nodiscard]] static double speed(Sample x, const Look& look) noexcept {
    const std::size_t n = 2 * look.half;
    const double x0 = x(look.half), before = x0 - x(n - 1), after = x(0) - x0;
    const double least = 0.5 * look.moving * static_cast<double>(look.half);
    if (before * after >= 0.0 || std::min(std::abs(before), std::abs(after)) < least) return 0.0;
    // The least squares' parabola, over polynomials that are orthogonal: 1, p, p^2 - spread.
    const double points = static_cast<double>(n), spread = (points * points - 1.0) / 12.0;
    double sum = 0.0, slope = 0.0, bend = 0.0, squares = 0.0, bends = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      const double p = static_cast<double>(i) - 0.5 * (points - 1.0), p2 = p * p - spread;
      const double y = i < look.half ? x(n - 1 - i) - x0 : x0 - x(n - 1 - i);
      sum += y, slope += p * y, bend += p2 * y, squares += y * y, bends += p2 * p2;
    }
    const double rest = squares - sum * sum / points - slope * slope / (points * spread) - bend * bend / bends;
    return rest <= points * look.rough * look.rough ? std::abs(slope) / (points * spread) : 0.0;
  }
};

}  // namespace ligature::control
