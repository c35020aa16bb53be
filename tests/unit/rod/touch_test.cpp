// Touch moves the points of a contact along two strands: they follow sliding strands with a lag that is known, and do
// not oscillate although the strands respond one substep late.

#include <gtest/gtest.h>

#include <cmath>

#include "firmware/physics/rod/contact/touch.hpp"

namespace ligature::test {
namespace {

using physics::rod::Touch;
using physics::rod::tuning;

constexpr double kCosines[] = {-1.0, -0.999999, -0.9, -0.3, 0.0, 0.4, 0.99, 0.9999, 0.999999999};

// Pressing at x turns strands that cross at the origin by an angle in proportion to x. So in the next substep their
// closest points are at -gain x / h, with h = 1 - c where both points move alike, 1 + c where they move oppositely. If
// the points followed all the way, x would be multiplied by gain / h in each substep.
void ring(Touch& touch, double cosine, double gain) {
  const double h = 1.0 - cosine, against = 1.0 + cosine;
  const double common = h > 0.0 ? -gain / h * (touch.a + touch.b) : 0.0;
  const double opposite = against > 0.0 ? -gain / against * (touch.a - touch.b) : 0.0;
  touch.follow(0.5 * (common + opposite), 0.5 * (common - opposite), cosine);
}

TEST(Touch, ComesToRestAtAnyAngleWhileTheGainIsBelowTwiceTheLag) {
  for (const double cosine : kCosines) {
    for (const double gain : {0.5, 1.0, 1.9}) {
      Touch touch{1e-4, 0.7e-4};
      for (int k = 0; k < 300; ++k) ring(touch, cosine, gain * tuning.touch_lag);
      if (cosine < 1.0) {
        EXPECT_LT(std::abs(touch.a + touch.b), 1e-9) << cosine << ' ' << gain;
      }
      if (cosine > -1.0) {
        EXPECT_LT(std::abs(touch.a - touch.b), 1e-9) << cosine << ' ' << gain;
      }
    }
  }
}

// Closest points that go on by the way w in each substep are `lag w / h` ahead of the touch, the sum of a geometric
// series.
TEST(Touch, LagsBehindWhatSlidesByTheLagOverH) {
  constexpr double kWay = 1e-6;
  for (const double cosine : {-0.9, -0.3, 0.0, 0.4, 0.9}) {
    for (const double sense : {1.0, -1.0}) {  // both points alike, oppositely
      Touch touch;
      for (int k = 1; k <= 200; ++k) touch.follow(kWay * k, sense * kWay * k, cosine);
      const double lag = tuning.touch_lag / (1.0 - sense * cosine) * kWay;
      EXPECT_NEAR(touch.a, 200 * kWay - lag, 1e-6 * kWay) << cosine << ' ' << sense;
      EXPECT_NEAR(touch.b, sense * touch.a, 1e-6 * kWay) << cosine << ' ' << sense;
    }
  }
}

TEST(Touch, OfParallelStrandsStaysWhereTheirDistanceDoesNotChange) {
  Touch touch{1e-4, 2e-4};
  touch.follow(5e-4, 6e-4, 1.0);  // both points by 4e-4 along strands that run side by side
  EXPECT_DOUBLE_EQ(touch.a, 1e-4);
  EXPECT_DOUBLE_EQ(touch.b, 2e-4);
  touch.follow(1e-4 + 1e-4, 2e-4 - 1e-4, 1.0);  // oppositely
  EXPECT_NEAR(touch.a - touch.b, -1e-4 + 2e-4 * 2.0 / (2.0 + tuning.touch_lag), 1e-12);
}

}  // namespace
}  // namespace ligature::test
