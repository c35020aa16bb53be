#pragma once

#include <numbers>

#include "firmware/physics/v3.hpp"

namespace ligature::physics {

/// Angle between two unit vectors from its sine s and cosine c, without branches: atan2(s, c) for s >= 0.
///   alpha = 2 atan(s / (1 + |c|)),  or pi minus that when c < 0
/// atan is a polynomial of degree 17 on [0, 1], interpolated at the Chebyshev points. The paper's formulas with arcsin
/// or acos lose half of the digits near a right angle or near a straight thread. They give NaN when rounding lifts
/// their argument above 1: with the printed form in 5 % of right-angled bends.
/// @param s  >= 0    @param c  any sign; s^2 + c^2 near 1 (or both 0, which gives 0)
/// @return rad in [0, pi]; absolute error below 4e-15. Cost: 18 multiply-adds and one division.
template <class S>
[[gnu::always_inline]] inline S bend_angle(S s, S c) noexcept {
  constexpr double kTwiceAtan[] = {
      1.9999999999999976,   -0.6666666666650657,  0.3999999998263839,    -0.28571427820853545,  0.22222204998844483,
      -0.18181575936026106, 0.15382340135883932,  -0.13318239887286146,  0.11691175424767732,   -0.10255658049227419,
      0.08754380021423046,  -0.06974900688985851, 0.04917832843612938,   -0.028917617473779387, 0.013285236797674021,
      -0.0043967810220676,  0.000922294245279125, -9.144933505719492e-05};
  const S t = s / (1.0 + magnitude(c));
  const S z = t * t;
  S sum = z * kTwiceAtan[17] + kTwiceAtan[16];
#pragma GCC unroll 16
  for (int k = 15; k >= 0; --k) sum = sum * z + kTwiceAtan[k];
  const S alpha = t * sum;
  return c < 0.0 ? std::numbers::pi - alpha : alpha;
}

}  // namespace ligature::physics
