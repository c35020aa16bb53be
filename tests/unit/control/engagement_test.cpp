// Engagement: the gain, 0 to 1, by which a hand's coupling force fades in and out.
#include "firmware/control/engagement.hpp"

#include <gtest/gtest.h>

namespace ligature::control {
namespace {

constexpr double kStill = 0.0, kSmall = 0.0;

TEST(Engagement, RisesInHalfASecondAfterTheCalm) {
  Engagement e;
  for (int i = 0; i < Engagement::kCalmTicks; ++i) e.tick(true, kStill, kSmall);
  EXPECT_EQ(e.gain(), 0.0);
  double before = 0.0;
  for (int i = 0; i < Engagement::kRiseTicks; ++i) {
    EXPECT_LT(e.gain(), 1.0);
    e.tick(true, 1.0, 3.0);  // once the gain has begun to rise, motion and force no longer stop it
    EXPECT_GT(e.gain(), before);
    before = e.gain();
  }
  EXPECT_EQ(e.gain(), 1.0);
}

TEST(Engagement, WaitsWhileTheHandMovesOrTheForceIsLarge) {
  Engagement moving, pushed;
  for (int i = 0; i < 1000; ++i) {
    moving.tick(true, 0.06, kSmall);
    pushed.tick(true, kStill, 0.6);
  }
  EXPECT_EQ(moving.gain(), 0.0);
  EXPECT_EQ(pushed.gain(), 0.0);
}

TEST(Engagement, FallsInFiftyMillisecondsAndMustBeCalmAgain) {
  Engagement e;
  for (int i = 0; i < 1000; ++i) e.tick(true, kStill, kSmall);
  for (int i = 0; i < Engagement::kFallTicks + 1; ++i) e.tick(false, kStill, kSmall);
  EXPECT_EQ(e.gain(), 0.0);
  for (int i = 0; i < 100; ++i) e.tick(true, 1.0, kSmall);
  EXPECT_EQ(e.gain(), 0.0);
}

/// The gain rises after twenty consecutive still ticks; a disturbance restarts the count.
TEST(Engagement, TheCalmIsCountedAnew) {
  const auto calm_after = [](const auto& disturb) {
    Engagement e;
    for (int i = 0; i < Engagement::kCalmTicks - 1; ++i) e.tick(true, kStill, kSmall);
    disturb(e);
    int calm = 0;
    for (; e.gain() == 0.0 && calm < 100; ++calm) e.tick(true, kStill, kSmall);
    return calm - 1;  // the last tick is already the first of the rise
  };
  EXPECT_EQ(calm_after([](Engagement&) {}), 1);
  EXPECT_EQ(calm_after([](Engagement& e) { e.tick(true, 1.0, kSmall); }), Engagement::kCalmTicks);
  EXPECT_EQ(calm_after([](Engagement& e) { e.tick(true, kStill, 3.0); }), Engagement::kCalmTicks);
  EXPECT_EQ(calm_after([](Engagement& e) { e.tick(false, kStill, kSmall); }), Engagement::kCalmTicks);
  EXPECT_EQ(calm_after([](Engagement& e) { e.drop(); }), Engagement::kCalmTicks);
}

TEST(Engagement, DropsAtOnce) {
  Engagement e;
  for (int i = 0; i < 1000; ++i) e.tick(true, kStill, kSmall);
  e.drop();
  EXPECT_EQ(e.gain(), 0.0);
}

}  // namespace
}  // namespace ligature::control
