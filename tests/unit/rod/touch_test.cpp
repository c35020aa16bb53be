// Touch moves the points of a contact along two strands: they follow sliding strands with a lag that is known, and do
// not oscillate although the strands respond one substep late.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "firmware/physics/rod/contact/touch.hpp"

namespace ligature::test {
namespace {

using physics::rod::Touch;
using physics::rod::tuning;

constexpr double kCosines[] = {-1.0, -0.999999, -0.9, -0.3, 0.0, 0.4, 0.99, 0.9999, 0.999999999, 1.0};

// Pressing at x turns strands that cross at the origin by an angle in proportion to x. So `delay` substeps later their
// closest points are at -gain x / h, with h = 1 - c where both points move alike, 1 + c where they move oppositely. If
// the points followed all the way, x would be multiplied by gain / h in each substep. @return the larger of |a + b| and
// |a - b| after 1000 substeps; for parallel strands only the one that can change
double rest_of_ringing(double cosine, double gain, std::size_t delay) {
  const double h = 1.0 - cosine, against = 1.0 + cosine;
  std::vector<Touch> past(delay, Touch{1e-4, 0.7e-4});
  Touch touch = past.back();
  for (int k = 0; k < 1000; ++k) {
    const Touch& pressed = past.front();
    const double common = h > 0.0 ? -gain / h * (pressed.a + pressed.b) : 0.0;
    const double opposite = against > 0.0 ? -gain / against * (pressed.a - pressed.b) : 0.0;
    touch.follow(0.5 * (common + opposite), 0.5 * (common - opposite), cosine);
    past.erase(past.begin());
    past.push_back(touch);
  }
  return std::max(h > 0.0 ? std::abs(touch.a + touch.b) : 0.0, against > 0.0 ? std::abs(touch.a - touch.b) : 0.0);
}

TEST(Touch, ComesToRestAtAnyAngleWhileTheGainIsBelowTwiceTheLag) {
  for (const double cosine : kCosines) {
    for (const double gain : {0.5, 1.0, 1.9})
      EXPECT_LT(rest_of_ringing(cosine, gain * tuning.touch_lag, 1), 1e-9) << cosine << ' ' << gain;
  }
  EXPECT_GT(rest_of_ringing(0.999999, 2.1 * tuning.touch_lag, 1), 1e-4) << "the bound is sharp";
}

TEST(Touch, ComesToRestAfterADelayOfTwoSubstepsWhileTheGainIsBelowTheLag) {
  for (const double cosine : kCosines) {
    for (const double gain : {0.25, 0.5, 0.95})
      EXPECT_LT(rest_of_ringing(cosine, gain * tuning.touch_lag, 2), 1e-9) << cosine << ' ' << gain;
  }
  EXPECT_GT(rest_of_ringing(0.999999, 1.1 * tuning.touch_lag, 2), 1e-4) << "the bound is sharp";
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

// By the law alone, a would go back by a quarter of b's way.
TEST(Touch, GoesNeitherBackNorBeyondTheClosestPoint) {
  Touch touch{1e-4, 1e-4};
  touch.follow(1e-4, 3e-4, 0.9999);
  EXPECT_DOUBLE_EQ(touch.a, 1e-4);
  EXPECT_NEAR(touch.b, 1e-4 + 0.5 * 2e-4 * (1e-4 / (1e-4 + tuning.touch_lag) + 1.9999 / (1.9999 + tuning.touch_lag)),
              1e-12);
  touch = {1e-4, 1e-4};
  touch.follow(1.1e-4, -9e-4, 0.9999);  // a would go on by 5e-4
  EXPECT_DOUBLE_EQ(touch.a, 1.1e-4);
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
