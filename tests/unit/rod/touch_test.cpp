// Touch moves a contact point along two strands: it follows sliding strands, and does not oscillate although the
// strands respond one substep late.

#include <gtest/gtest.h>

#include <cmath>

#include "firmware/physics/rod/contact/touch.hpp"

namespace ligature::test {
namespace {

using physics::rod::Touch;

// Pressing at x turns the strands, so that in the next substep their closest points are at -gain x. If the contact
// point followed them fully, x would be multiplied by the gain in each substep.
void ring(Touch& touch, double gain, int substeps) {
  for (int k = 0; k < substeps; ++k) touch.follow(-gain * touch.a, -gain * touch.b);
}

TEST(Touch, ComesToRestWhatEverAnswersASubstepLate) {
  for (const double gain : {0.0, 0.5, 1.0, 1.5, 5.0, 25.0}) {
    Touch touch;
    touch.begin(1e-4, -0.7e-4);
    ring(touch, gain, 100);
    EXPECT_LT(std::hypot(touch.a, touch.b), 1e-9) << gain;
  }
}

TEST(Touch, FollowsWhatSlidesWithoutLag) {
  constexpr double kWay = 1e-6;
  Touch touch;
  touch.begin(0.0, 0.0);
  for (int k = 1; k <= 50; ++k) {
    touch.follow(kWay * k, -2.0 * kWay * k);
    EXPECT_DOUBLE_EQ(touch.a, kWay * k);
    EXPECT_DOUBLE_EQ(touch.b, -2.0 * kWay * k);
  }
}

TEST(Touch, FollowsAgainWithinTwoMillisecondsOfRinging) {  // 2 ms are 32 substeps
  constexpr double kWay = 1e-6;
  Touch touch;
  touch.begin(1e-4, 0.0);
  ring(touch, 25.0, 60);
  EXPECT_LT(touch.share, 0.1);
  const double from = touch.a;
  for (int k = 1; k <= 32; ++k) touch.follow(from + kWay * k, 0.0);
  EXPECT_NEAR(touch.a, from + 32 * kWay, 0.1 * kWay);
}

}  // namespace
}  // namespace ligature::test
