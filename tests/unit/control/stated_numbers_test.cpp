// Times and limits that the documentation states, measured here without the code's own constants.
#include "firmware/control/engagement.hpp"
#include "firmware/control/force_limiter.hpp"
#include "tests/unit/control/controller_rig.hpp"

namespace ligature::control {
namespace {

constexpr double kLever_m = 0.1924;  // lever arm of the waist joint in the rig's pose

/// Fault of a disarmed rig whose left tip moves at this speed for 20 ms.
Fault fault_at(double speed_m_per_s) {
  Rig rig;
  rig.controller.command(rt::CommandKind::kDisarm);
  rig.ticks(100);
  for (int i = 0; i < 20 && rig.controller.fault() == Fault::kNone; ++i) {
    rig.in.reading.hand[0].q_rad[0] += 1e-3 * speed_m_per_s / kLever_m;
    rig.tick();
  }
  return rig.controller.fault();
}

TEST(StatedNumbers, TheVelocityFaultIsAtOneAndAHalfTimesTheLimit) {  // 2 m/s for an Omni
  EXPECT_EQ(fault_at(2.9), Fault::kNone);
  EXPECT_EQ(fault_at(3.1), Fault::kVelocityLimit);
}

int ticks_in_calibrate(Rig& rig) {
  int ticks = 0;
  for (int i = 0; i < 1000 && rig.controller.state() <= State::kCalibrate; ++i) {
    ticks += rig.controller.state() == State::kCalibrate;
    rig.tick();
  }
  return ticks;
}

TEST(StatedNumbers, CalibrationTakesFiftyPossiblePosesInARow) {
  Rig rig;
  EXPECT_EQ(ticks_in_calibrate(rig), 50);

  // 30 plausible samples, then implausible ones (more than 0.25 rad beyond the joint's stop), so the count restarts.
  Rig doubtful;
  for (auto& hand : doubtful.in.reading.hand) hand.q_rad[0] = 1.22;
  doubtful.ticks(31);
  for (const double turn_rad : {0.005, 0.005, 0.005, 0.005, -0.005, -0.005, -0.005}) {
    doubtful.in.reading.hand[1].q_rad[0] += turn_rad;
    doubtful.tick();
  }
  ASSERT_EQ(doubtful.controller.state(), State::kCalibrate);
  doubtful.in.reading.hand[1].q_rad[0] -= 0.005;
  EXPECT_EQ(ticks_in_calibrate(doubtful), 48);  // the last two samples of the loop above were plausible already
}

TEST(StatedNumbers, TheGainRisesInHalfASecondAndFallsInFiftyMilliseconds) {
  Engagement e;
  int calm = 0, rise = 0, fall = 0;
  for (; e.gain() == 0.0 && calm < 1000; ++calm) e.tick(true, 0.0, 0.0);
  for (; e.gain() < 1.0 && rise < 2000; ++rise) e.tick(true, 0.0, 0.0);
  for (; e.gain() > 0.0 && fall < 2000; ++fall) e.tick(false, 0.0, 0.0);
  EXPECT_EQ(calm, 21);  // 20 ticks of a still hand, then the first of the rise
  EXPECT_EQ(rise + 1, 500);
  EXPECT_EQ(fall, 50);
}

TEST(StatedNumbers, AHandIsStillBelowFiveCentimetresASecondAndHalfANewton) {
  const auto rises = [](double speed_m_per_s, double force_N) {
    Engagement e;
    for (int i = 0; i < 100; ++i) e.tick(true, speed_m_per_s, force_N);
    return e.gain() > 0.0;
  };
  EXPECT_TRUE(rises(0.049, 0.49));
  EXPECT_FALSE(rises(0.051, 0.0));
  EXPECT_FALSE(rises(0.0, 0.51));
}

TEST(StatedNumbers, AHotWindingsCapFallsInHalfASecondAndComesBackAsSlowly) {
  const auto d = device::omni();
  ForceLimiter limiter(d, 3.3, 1e-3);
  const auto tick = [&](double wish_N) { limiter.sent(limiter.limit(physics::Vec3(0, 0, wish_N))); };
  int ticks = 0;
  for (; limiter.cap_N() == 3.3 && ticks < 20'000; ++ticks) tick(3.3);
  EXPECT_NEAR(limiter.heat(), 1.0, 0.01);
  int fall = 1, back = 1;
  for (; limiter.cap_N() > 0.88 && fall < 20'000; ++fall) tick(3.3);
  EXPECT_NEAR(fall, 500, 1);
  for (ticks = 0; limiter.cap_N() == 0.88 && ticks < 20'000; ++ticks) tick(0.0);
  EXPECT_NEAR(limiter.heat(), 0.7, 0.01);
  for (; limiter.cap_N() < 3.3 && back < 20'000; ++back) tick(0.0);
  EXPECT_NEAR(back, 500, 1);
}

TEST(StatedNumbers, AChangeOfTheForceScaleTakesTwoTenthsOfASecond) {  // linearly, from one steady force to another
  for (const double times : {2.0, 0.5}) {
    Rig rig;
    rig.to_force();
    const double before_N = rig.controller.hand(0).f_wish_N.norm();
    rig.controller.change_force_scale(times * Rig::scene().force_scale);
    const double step_N = (times - 1.0) * before_N / 200.0;
    for (int i = 1; i <= 210; ++i) {
      rig.tick();
      for (std::size_t h = 0; h < 2; ++h)
        ASSERT_NEAR(rig.controller.hand(h).f_wish_N.norm(), before_N + step_N * std::min(i, 200), 1e-9) << i;
    }
  }
}

// A parked tool must not keep the hand's velocity, or it would throw what it holds.
TEST(StatedNumbers, AParkedToolStands) {
  Rig rig;
  rig.to_force();
  for (int i = 0; i < 30; ++i) {
    rig.in.reading.hand[0].q_rad[0] += 1e-3 * 0.3 / kLever_m;
    rig.tick();
  }
  ASSERT_GT(rig.controller.hand(0).v_WT.norm(), 1.0);  // in world units, 20 times the device's
  rig.in.reading.hand[0].clutch = true;
  for (int i = 0; i < 30; ++i) {
    rig.in.reading.hand[0].q_rad[0] += 1e-3 * 0.3 / kLever_m;
    rig.tick();
    ASSERT_EQ(rig.controller.tools()[0].v_WT.norm(), 0.0) << i;
    ASSERT_EQ(rig.controller.hand(0).v_WT.norm(), 0.0) << i;
  }
}

/// A drive keeps its torque. Normally the torque check would find this first (fault 26). Here the watchdog time is
/// long, so the torque check still accepts the torque as that of an old command, and another limit must end it.
TEST(StatedNumbers, AForceThatDoesNotEndIsTakenAfterAHundredTicks) {
  Rig rig(Rig::scene(), device::omni(), 1000);
  rig.to_force();
  rig.pull_hard();
  const auto asked = rig.tick();
  for (std::size_t j = 0; j < rt::kJoints; ++j) rig.in.reading.hand[0].torque_Nm[j] = asked.hand[0].torque_Nm[j];
  rig.controller.command(rt::CommandKind::kDisarm);
  int ticks = 0;
  for (; ticks < 1000 && rig.controller.fault() == Fault::kNone; ++ticks) rig.tick();
  EXPECT_NEAR(ticks, 151, 1);
  EXPECT_EQ(rig.controller.fault(), Fault::kForceStays);
}

}  // namespace
}  // namespace ligature::control
