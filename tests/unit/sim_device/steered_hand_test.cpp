#include "sim_device/page/steered_hand.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "sim_device/mechanics.hpp"
#include "tests/support/random.hpp"
#include "tests/unit/sim_device/omni.hpp"

namespace ligature::sim {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

const Vec3 kThere = home_tip_D_m() + Vec3(0.03, -0.02, 0.04);
constexpr double kSilence_s = SteeredHand::kLongestSilence_s;

TEST(SteeredHand, RestsAtHomeWithTheDeadManLetGoUntilItIsWishedElsewhere) {
  SteeredHand hand(Linkage{});
  for (const double t_s : {-std::numeric_limits<double>::infinity(), 0.0, 5.0}) {
    EXPECT_EQ(hand.at(t_s).p_DH, home_tip_D_m());
    EXPECT_FALSE(hand.at(t_s).dead_man);
  }
  // This target comes before the drives are enabled, so it is ignored.
  hand.wish(-std::numeric_limits<double>::infinity(), kThere, true, true);
  EXPECT_EQ(hand.at(1.0).p_DH, home_tip_D_m());
  EXPECT_FALSE(hand.at(1.0).grip);
}

/// Sends targets at 50 Hz from `from_s` on, as a page does. @return the time of the last one.
double keep_wishing(SteeredHand& hand, double from_s, double to_s, const Vec3& p_D_m, bool dead_man) {
  double t_s = from_s;
  for (; t_s < to_s; t_s += 0.02) hand.wish(t_s, p_D_m, dead_man, true);
  return t_s - 0.02;
}

TEST(SteeredHand, ArrivesWhereItIsWishedAndRestsThere) {
  SteeredHand hand(Linkage{});
  const double last_s = keep_wishing(hand, 0.0, 1.0, kThere, false);
  const Intent now = hand.at(last_s + 0.01);
  EXPECT_LT((now.p_DH - kThere).norm(), 1e-9);
  EXPECT_LT(now.v_DH.norm(), 1e-9);
  EXPECT_TRUE(now.grip);
}

TEST(SteeredHand, TheDeadManCountsOnlyAfterItWasSeenReleased) {
  SteeredHand hand(Linkage{});
  double t_s = keep_wishing(hand, 0.0, 0.5, kThere, true);
  EXPECT_FALSE(hand.at(t_s).dead_man) << "pressed since before it had the hand";
  t_s = keep_wishing(hand, 0.5, 0.6, kThere, false);
  t_s = keep_wishing(hand, 0.6, 0.7, kThere, true);
  EXPECT_TRUE(hand.at(t_s).dead_man);
  EXPECT_TRUE(hand.at(t_s + kSilence_s).dead_man);
  EXPECT_FALSE(hand.at(t_s + kSilence_s + 1e-9).dead_man);
  t_s = keep_wishing(hand, t_s + kSilence_s + 0.01, 1.5, kThere, true);
  EXPECT_FALSE(hand.at(t_s).dead_man) << "the silence let go, and nobody has pressed anew";
  t_s = keep_wishing(hand, 1.5, 1.6, kThere, false);
  t_s = keep_wishing(hand, 1.6, 1.7, kThere, true);
  EXPECT_TRUE(hand.at(t_s).dead_man);
}

TEST(SteeredHand, SilenceBringsItToRestOnTheSpotWithItsJawsAsTheyWere) {
  SteeredHand hand(Linkage{});
  hand.wish(0.0, home_tip_D_m() + Vec3(0.1, 0.0, 0.0), false, true);
  const Intent then = hand.at(kSilence_s);
  ASSERT_GT(then.v_DH.norm(), 0.1) << "on its way";
  const Intent later = hand.at(10.0);
  EXPECT_LT(later.v_DH.norm(), 1e-12);
  EXPECT_LT((later.p_DH - then.p_DH).norm(), 0.03);
  EXPECT_TRUE(later.grip);
}

TEST(SteeredHand, WhatIsOutOfReachIsBroughtBackToTheEdgeOfIt) {
  const Linkage linkage;
  for (const Vec3& direction :
       {Vec3(1.0, 0.0, 0.0), Vec3(0.0, -1.0, 0.0), Vec3(0.0, 0.0, 1.0), Vec3(-3.0, 4.0, -5.0)}) {
    SteeredHand hand(linkage);
    keep_wishing(hand, 0.0, 3.0, linkage.home_D_m() + 10.0 * direction, false);
    const Vec3 p_D_m = hand.at(3.0).p_DH;
    const auto q = linkage.joints(p_D_m);
    ASSERT_TRUE(q && linkage.is_within_stops(*q)) << direction.transpose();
    EXPECT_LT((p_D_m - linkage.home_D_m()).cross(direction.normalized()).norm(), 1e-9);
    const auto beyond = linkage.joints(p_D_m + 1e-5 * direction);
    EXPECT_FALSE(beyond && linkage.is_within_stops(*beyond)) << "as far as it goes";
  }
}

TEST(SteeredHand, NoNumberIsNoWish) {
  SteeredHand hand(Linkage{});
  keep_wishing(hand, 0.0, 1.0, kThere, false);
  hand.wish(1.0, Vec3::Constant(std::numeric_limits<double>::quiet_NaN()), true, false);
  EXPECT_TRUE(hand.at(1.0).p_DH.allFinite());
  EXPECT_TRUE(hand.at(1.0).grip);
}

/// Whatever targets come, at whatever times: the hand keeps within an arm's speed and acceleration, and never jumps.
TEST(SteeredHand, KeepsToTheLimitsOfAnArmWhateverIsWished) {
  const ArmLimits limits;
  test::Random random(20);
  SteeredHand hand(Linkage{});
  constexpr double kTick_s = 1e-3;
  double wish_at_s = 0.0;
  Intent before = hand.at(0.0);
  for (double t_s = 0.0; t_s < 120.0; t_s += kTick_s) {
    if (t_s >= wish_at_s) {
      const Vec3 offset{random.in(-0.1, 0.1), random.in(-0.1, 0.1), random.in(-0.1, 0.1)};
      hand.wish(t_s, home_tip_D_m() + offset, random.happens(0.5), false);
      wish_at_s = t_s + random.in(0.0, 0.5);
    }
    const Intent now = hand.at(t_s + kTick_s);
    for (int axis = 0; axis < 3; ++axis) {
      ASSERT_LE(std::abs(now.v_DH[axis]), limits.speed_m_per_s * (1.0 + 1e-6)) << t_s;
      ASSERT_LE(std::abs(now.v_DH[axis] - before.v_DH[axis]), limits.acceleration_m_per_s2 * kTick_s * (1.0 + 1e-3));
      ASSERT_LE(std::abs(now.p_DH[axis] - before.p_DH[axis]), limits.speed_m_per_s * kTick_s * (1.0 + 1e-3));
    }
    before = now;
  }
}

/// A person steers the hand from the page. The device reports the person's dead-man as its own button while the drives
/// are on.
TEST(SteeredHand, ThePersonsDeadManIsTheDevicesWhileItsDrivesAreOn) {
  auto steered = std::make_unique<SteeredHand>(Linkage{});
  SteeredHand& hand = *steered;
  Mechanics m(std::move(steered), Time(0));
  auto live = [&, now = Time(0)](bool pressed, bool on, int ms) mutable {
    for (int i = 0; i < ms; ++i) {
      now += milliseconds(1);
      m.feel_drives(on, now);
      m.advance(now, Vec3::Zero());
      hand.wish(m.script_time_s(), kThere, pressed, false);
    }
    return (m.buttons() & can::profile::kButtonDeadMan) != 0;
  };
  EXPECT_FALSE(live(false, true, 100));
  EXPECT_TRUE(live(true, true, 1000));
  EXPECT_LT((m.plant().tip_D_m() - kThere).norm(), 1e-3);
  EXPECT_FALSE(live(true, false, 10));
  EXPECT_TRUE(live(true, true, 300)) << "as any operator's: pressed again 0.2 s after the drives are on";
  EXPECT_FALSE(live(false, true, 1));
}

}  // namespace
}  // namespace ligature::sim
