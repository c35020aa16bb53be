#pragma once
// Distinguishes a joint that reverses its motion from an encoder that begins to count backwards.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace ligature::control {

/// The test for a reversed encoder. A turn is a place where the readings change their direction; its halves are equally
/// many readings before and after it. An encoder that begins to count backwards at the position x0 reports 2 x0 - x
/// from there on, instead of x. So if the second half is mirrored at x0, it continues the first half as one smooth
/// curve. A reversal is suspected when one parabola fits both halves, except for errors as small as those of rounding
/// to counts.
///
/// A hand that really turns a joint, from speed u to -u with acceleration a, needs the time 2 u / a for that. If the
/// motion before the turn is extended at speed u to the middle of the turn, it ends u^2 / (2 a) beyond the turning
/// point x0. The motion after the turn, mirrored and extended in the same way, begins u^2 / (2 a) before x0. So at the
/// middle of the turn there is a jump of u^2 / a between the halves. If the jump is two counts or more, no reversal is
/// suspected. At u counts per period this holds up to the acceleration u^2 / 2, which is 49 m/s2 at 1.4 counts per
/// period (70 mm/s at an Omni's tip). A slower joint passes fewer counts per period, so it is tested with longer
/// halves. False alarms and missed reversals: docs/encoder-watch.md. O(kLongest), no allocation.
class MirroredTurn {
 public:
  struct Look {
    std::size_t half;  ///< samples in each half
    double moving;     ///< least speed at the turn, counts a period
    double rough;      ///< largest rms residual of the parabola, counts; rounding alone makes 0.29
    bool alone;        ///< false: suspected only if another joint moves on as before
  };
  static constexpr std::array<Look, 4> kLooks{
      {{6, 1.4, 0.4, true}, {12, 0.85, 0.4, true}, {24, 0.6, 0.4, true}, {24, 0.44, 0.36, false}}};
  static constexpr std::size_t kLongest = 24;

  /// @param x samples: x(0) is the newest, x(2 half - 1) the oldest, x(half) the last one before the suspected
  /// reversal.
  /// @return speed at the turn, counts per period; 0 if the samples do not turn, or turn unlike those of a reversed
  /// encoder.
  template <class Sample>
  [[nodiscard]] static double speed(Sample x, const Look& look) noexcept {
    const std::size_t n = 2 * look.half;
    const double x0 = x(look.half), before = x0 - x(n - 1), after = x(0) - x0;
    const double least = 0.5 * look.moving * static_cast<double>(look.half);
    if (before * after >= 0.0 || std::min(std::abs(before), std::abs(after)) < least) return 0.0;
    // Least-squares parabola in the orthogonal polynomials 1, p, p^2 - spread.
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
