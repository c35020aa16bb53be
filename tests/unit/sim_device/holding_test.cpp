#include "sim_device/page/holding.hpp"

#include <gtest/gtest.h>

namespace ligature::sim {
namespace {

using std::chrono::milliseconds;

struct Held {
  std::int64_t numbers = 100;
  Holding holding{[this] { return ++numbers; }};
};

TEST(Holding, TheFirstHasTheHandAndNobodyElse) {
  Held h;
  const auto session = h.holding.session();
  EXPECT_TRUE(h.holding.accept({session, 7, 1}, Time(0)));
  EXPECT_EQ(h.holding.owner(), 7);
  EXPECT_FALSE(h.holding.accept({session, 8, 2}, Time(0)));
  EXPECT_TRUE(h.holding.accept({session, 7, 2}, Time(0)));
  EXPECT_EQ(h.holding.sequence(), 2);
}

TEST(Holding, NobodyIsNoOwnerAndAnotherSessionNone) {
  Held h;
  EXPECT_FALSE(h.holding.accept({h.holding.session(), 0, 1}, Time(0)));
  EXPECT_FALSE(h.holding.accept({h.holding.session() + 1, 7, 1}, Time(0)));
  EXPECT_FALSE(h.holding.accept({h.holding.session(), 7, 0}, Time(0)));
  EXPECT_EQ(h.holding.owner(), 0);
}

TEST(Holding, WhatIsSaidTwiceOrLateIsNotDone) {
  Held h;
  const auto session = h.holding.session();
  EXPECT_TRUE(h.holding.accept({session, 7, 5}, Time(0)));
  for (const std::int64_t old : {5, 4, 1, -1}) EXPECT_FALSE(h.holding.accept({session, 7, old}, Time(0))) << old;
  EXPECT_TRUE(h.holding.accept({session, 7, 6}, Time(0)));
}

TEST(Holding, ALongSilenceFreesTheHandAndEndsTheSession) {
  Held h;
  const auto session = h.holding.session();
  ASSERT_TRUE(h.holding.accept({session, 7, 1}, Time(0)));
  h.holding.look(Holding::kFreeAfter);
  EXPECT_EQ(h.holding.owner(), 7);
  h.holding.look(Holding::kFreeAfter + Time(1));
  EXPECT_EQ(h.holding.owner(), 0);
  EXPECT_NE(h.holding.session(), session);
  // The previous session is rejected, even from the same owner.
  EXPECT_FALSE(h.holding.accept({session, 7, 2}, Holding::kFreeAfter + milliseconds(1)));
  EXPECT_TRUE(h.holding.accept({h.holding.session(), 8, 1}, Holding::kFreeAfter + milliseconds(1)));
}

TEST(Holding, WhoLeavesIsDoneAndTheHandIsFree) {
  Held h;
  const auto session = h.holding.session();
  ASSERT_TRUE(h.holding.accept({session, 7, 1}, Time(0)));
  EXPECT_TRUE(h.holding.accept({session, 7, 2, true}, Time(0)));
  EXPECT_EQ(h.holding.owner(), 0);
  EXPECT_NE(h.holding.session(), session);
}

TEST(Holding, ARecordingOfAWholeHoldingMovesNothingWhileItGoesOnNorAfterIt) {
  Held h;
  std::vector<Claim> recorded;
  const auto say = [&](std::int64_t sequence, bool leaves) {
    recorded.push_back({h.holding.session(), 7, sequence, leaves});
    return h.holding.accept(recorded.back(), Time(0));
  };
  const auto play = [&] {
    for (const Claim& claim : recorded) EXPECT_FALSE(h.holding.accept(claim, Time(0))) << claim.sequence;
  };
  for (int i = 1; i < 50; ++i) {
    ASSERT_TRUE(say(i, false));
    play();
  }
  ASSERT_TRUE(say(50, true));
  play();
  EXPECT_EQ(h.holding.owner(), 0);
}

}  // namespace
}  // namespace ligature::sim
