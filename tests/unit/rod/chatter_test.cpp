// chatter() measures the rms deviation of a force from a smooth curve; here for forces whose deviation is known.

#include "tests/bench/rod/chatter.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

namespace ligature::test {
namespace {

using bench::Chatter;
using bench::chatter;

// Force of a pull, N per tick: it grows exponentially, as when an overhand knot is pulled tight, plus a sinusoidal
// fluctuation.
std::vector<double> pull(int ticks, double tremble_N, double period_ticks) {
  std::vector<double> f;
  for (int k = 0; k < ticks; ++k)
    f.push_back(0.05 * std::exp(3.0 * k / ticks) + tremble_N * std::sin(2.0 * std::numbers::pi * k / period_ticks));
  return f;
}

TEST(Chatter, FindsAKnownTremble) {
  for (const double period : {2.3, 5.0, 12.0}) {
    const Chatter c = chatter(pull(250, 5e-3, period), 0.04);
    EXPECT_NEAR(c.rms_N, 5e-3 / std::numbers::sqrt2, 0.12 * 5e-3) << period;
    EXPECT_EQ(c.ticks, 200);
  }
}

TEST(Chatter, IsNotThePull) {
  EXPECT_LT(chatter(pull(250, 0.0, 1.0), 0.04).share(), 1e-3);
  // Five times as fast, so the stretch is shorter than the fit's window.
  EXPECT_LT(chatter(pull(50, 0.0, 1.0), 0.04).share(), 2e-3);
}

// At 1 m/s a complete pull to 1 N takes only 14 ticks. A smooth force must count as nearly no chatter even then.
TEST(Chatter, IsNotAPullOfFourteenTicks) { EXPECT_LT(chatter(pull(14, 0.0, 1.0), 0.04).share(), 2e-3); }

// Independent fluctuations add as squares. By this rule docs/measurements/rod-knots.md separates the mesh's
// contribution from the thread's own vibration.
TEST(Chatter, AddsCausesAsSquares) {
  const auto one = pull(250, 3e-3, 5.3), other = pull(250, 4e-3, 3.7), smooth = pull(250, 0.0, 1.0);
  auto both = one;
  for (std::size_t k = 0; k < both.size(); ++k) both[k] += other[k] - smooth[k];
  const double a = chatter(one, 0.04).rms_N, b = chatter(other, 0.04).rms_N;
  EXPECT_NEAR(chatter(both, 0.04).rms_N, std::hypot(a, b), 0.03 * std::hypot(a, b));
}

// In the middle of the pull the loop snaps over and the force is zero for a while. The stretches on both sides count,
// the gap does not.
TEST(Chatter, IsNotASnapBetweenTwoStretches) {
  std::vector<double> f = pull(250, 0.0, 1.0);
  for (int k = 100; k < 130; ++k) f[static_cast<std::size_t>(k)] = 0.002;
  EXPECT_LT(chatter(f, 0.04).share(), 1e-3);
  for (int k = 0; k < 250; ++k) f[static_cast<std::size_t>(k)] += k % 2 == 0 ? 4e-3 : -4e-3;
  EXPECT_NEAR(chatter(f, 0.04).rms_N, 4e-3, 0.4e-3);
}

// A force peak of one tick, as occurs when the thread waits for lack of budget.
TEST(Chatter, CountsABlow) {
  std::vector<double> f = pull(250, 0.0, 1.0);
  f[180] += 0.1;
  EXPECT_NEAR(chatter(f, 0.04).rms_N, 0.1 / std::sqrt(200.0), 0.1 * 0.1 / std::sqrt(200.0));
}

TEST(Chatter, SaysWhenThereIsNothingToSay) {
  EXPECT_EQ(chatter(pull(250, 0.0, 1.0), 10.0).ticks, 0);
  EXPECT_EQ(chatter({}, 0.0).ticks, 0);
}

}  // namespace
}  // namespace ligature::test
