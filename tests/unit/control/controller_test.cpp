// The whole control law with encoder readings set by the tests: start-up to force, limits, clutch, and end of force.
#include <gtest/gtest.h>

#include <vector>

#include "tests/unit/control/controller_rig.hpp"

namespace ligature::control {
namespace {

// Tolerance for the rounding of torques, which are sent in whole per mille of 0.3 N m.
constexpr double kStay_Nm = 0.7 * 0.3e-3 * (1 + 1e-9);

TEST(Controller, ComesUpThroughEveryStateToForce) {
  Rig rig;
  std::vector<State> seen{rig.controller.state()};
  for (int i = 0; i < 1000; ++i) {
    rig.tick();
    if (rig.controller.state() != seen.back()) seen.push_back(rig.controller.state());
  }
  EXPECT_EQ(seen, (std::vector{State::kOff, State::kCalibrate, State::kIdle, State::kEngage, State::kForce}));
}

/// Drive errors before the drives are operational are not faults: start-up is still going on.
TEST(Controller, WaitsForDrivesThatAreUpAndFresh) {
  const std::vector<void (*)(rt::HandReading&)> kNotUp{
      [](auto& r) { r.drive_fault = true; }, [](auto& r) { r.enabled = false; }, [](auto& r) { r.valid = false; },
      [](auto& r) { r.age_ticks = 1; }, [](auto& r) { r.buttons_stuck = r.drive_fault = true; }};
  for (const auto& spoil : kNotUp) {
    Rig rig;
    const auto good = rig.in.reading.hand[1];
    spoil(rig.in.reading.hand[1]);
    rig.ticks(100);
    EXPECT_EQ(rig.controller.state(), State::kOff);
    EXPECT_EQ(rig.controller.fault(), Fault::kNone);
    rig.in.reading.hand[1] = good;
    rig.tick();
    EXPECT_EQ(rig.controller.state(), State::kCalibrate);
  }
}

TEST(Controller, EncodersMustShowAPossiblePoseForAWhile) {
  Rig rig;
  rig.tick();
  for (int i = 0; i < Controller::kCalibrationTicks; ++i, rig.tick())
    ASSERT_EQ(rig.controller.state(), State::kCalibrate) << i;
  EXPECT_EQ(rig.controller.state(), State::kIdle);
}

TEST(Controller, DoesNotEngageOnALargeForce) {  // 1.8 N; the gain rises only while the force is small
  Rig rig;
  rig.offset_m = 0.5;
  rig.ticks(1000);
  EXPECT_EQ(rig.controller.hand(0).gain, 0.0);
  EXPECT_EQ(rig.controller.state(), State::kEngage);
}

TEST(Controller, WithoutForceThereIsNothingToBrake) {
  Rig rig;
  rig.in.reading.hand[0].dead_man = rig.in.reading.hand[1].dead_man = false;
  rig.ticks(1000);
  for (int i = 0; i < 8; ++i) {
    rig.in.reading.hand[0].q_rad[0] += 2.4e-3 / 0.192;
    rig.tick();
    EXPECT_EQ(rig.controller.state(), State::kEngage) << i;
  }
}

// 1200 N/m x 0.05 m x force scale 0.003 = 0.18 N upwards on both hands
TEST(Controller, FeelsTheCouplingThroughTheLinkage) {
  Rig rig;
  rig.to_force();
  const auto command = rig.tick();
  const Vec3 expected = Linkage(device::omni()).torque({0.0, 0.5, 0.6}, Vec3(0, 0, 0.18));
  for (std::size_t j = 0; j < 3; ++j) {
    EXPECT_NEAR(command.hand[0].torque_Nm[j], expected[static_cast<Eigen::Index>(j)], kStay_Nm);
    EXPECT_NEAR(command.hand[1].torque_Nm[j], expected[static_cast<Eigen::Index>(j)], kStay_Nm);
  }
}

TEST(Controller, NeverExceedsTheForceLimitAndReportsIt) {
  Rig rig(Rig::scene(), Rig::drums());
  rig.to_force();
  rig.offset_m = 50.0;
  rig.ticks(40);  // reaches the peak limit at 0.15 N per tick
  EXPECT_TRUE(rig.controller.hand(0).limits & rt::kPeakLimit);
  EXPECT_NEAR(rig.controller.hand(0).f_device_N.norm(), 3.3, 1e-9);
  EXPECT_LE(rig.controller.hand(0).f_device_N.norm(), 3.3);
  EXPECT_TRUE(rig.controller.hand(0).limited);
  EXPECT_EQ(rig.controller.fault(), Fault::kNone);  // reaching a limit is not a fault
}

TEST(Controller, AnArmGetsWhatIsSafeInEveryPoseAndReportsIt) {
  Rig rig;
  rig.to_force();
  rig.pull_hard();
  const Vec3 torque_Nm = vector_of(rig.tick().hand[0].torque_Nm);
  EXPECT_NEAR(AnyPose(device::omni()).most_N(torque_Nm), 3.3, 0.01);
  EXPECT_EQ(rig.controller.hand(0).limits, rt::kTorqueLimit);
  EXPECT_TRUE(rig.controller.hand(0).limited);
  EXPECT_EQ(rig.controller.fault(), Fault::kNone);
}

// Outside the workspace box the force bound for any pose (AnyPose) does not hold. When the step limit keeps the last
// torques while the arm moves on, the same torques make another force. That force must stay below the device's peak
// force, too.
TEST(Controller, ThePeakHoldsForAnArmThatMovesOutsideItsWorkspaceBox) {
  auto hands = Rig::scene();
  hands.passivity = false;
  Rig rig(hands);
  const auto move = [&](double t_s) {
    rig.in.reading.hand[0].q_rad = {0.3 * std::sin(3.0 * t_s), 0.79 + 0.05 * std::sin(20.0 * t_s),
                                    0.38 + 0.03 * std::sin(17.0 * t_s)};
  };
  move(0.0);
  rig.to_force();
  double most_N = 0.0;
  int at_peak = 0;
  for (int i = 1; i < 400; ++i) {
    const double t_s = 1e-3 * i;
    move(t_s);
    const Vec3 along(-0.2, -0.4 * std::sin(250.0 * t_s), -1.0);
    rig.in.grasp[0].p_WG = rig.controller.hand(0).p_WT + 50.0 * along.normalized();
    rig.tick_as_is();
    const double f_N = rig.controller.hand(0).f_device_N.norm();
    most_N = std::max(most_N, f_N);
    at_peak += f_N > 3.29 ? 1 : 0;
  }
  EXPECT_LE(most_N, 3.3 * (1.0 + 1e-12));
  EXPECT_GT(at_peak, 20);
  EXPECT_EQ(rig.controller.fault(), Fault::kNone);
}

TEST(Controller, DoesNotEngageAHandThatMoves) {  // the left waist turns, and the tip moves at 0.1 m/s
  Rig rig;
  for (int i = 0; i < 500; ++i) {
    rig.in.reading.hand[0].q_rad[0] += 1e-3 * 0.1 / 0.1924;
    rig.tick();
  }
  EXPECT_EQ(rig.controller.fault(), Fault::kNone);
  EXPECT_EQ(rig.controller.hand(0).gain, 0.0);
  EXPECT_GT(rig.controller.hand(1).gain, 0.5);
}

TEST(Controller, NoJointIsAskedForMoreThanItsDriveGives) {
  auto weak = device::omni();
  weak.max_torque_permille = 200;
  Rig rig(Rig::scene(), weak);
  rig.to_force();
  rig.offset_m = 50.0;
  rig.ticks(40);
  EXPECT_NEAR(Rig::largest(rig.tick()), weak.max_torque_Nm(), 1e-9);
  EXPECT_TRUE(rig.controller.hand(0).limits & rt::kTorqueLimit);
}

TEST(Controller, AForceBelowTheLimitIsNotCalledLimited) {  // while the gain rises, and when not armed
  Rig rig;
  rig.to_force();
  rig.offset_m = 50.0;
  rig.ticks(40);
  rig.in.reading.hand[0].dead_man = false;
  rig.tick();
  EXPECT_LT(rig.controller.hand(0).f_device_N.norm(), 3.3);
  EXPECT_FALSE(rig.controller.hand(0).limited);
  EXPECT_TRUE(rig.controller.hand(1).limited);
}

TEST(Controller, NeedsBothArmingAndThatHandsDeadMan) {
  Rig rig;
  rig.in.reading.hand[1].dead_man = false;
  rig.to_force();
  EXPECT_GT(rig.controller.hand(0).f_device_N.norm(), 0.0);
  EXPECT_EQ(rig.controller.hand(1).f_device_N.norm(), 0.0);
  rig.controller.command(rt::CommandKind::kDisarm);
  rig.ticks(Engagement::kFallTicks + 2);
  EXPECT_EQ(rig.controller.state(), State::kIdle);
  EXPECT_EQ(Rig::largest(rig.tick()), 0.0);
}

// From the largest force, the step limit takes 14 more ticks.
TEST(Controller, ReleasedDeadManTakesTheForceInFiftyMilliseconds) {
  for (const bool largest : {false, true}) {
    Rig rig;
    rig.to_force();
    if (largest) rig.pull_hard();
    rig.in.reading.hand[0].dead_man = rig.in.reading.hand[1].dead_man = false;
    rig.ticks(Engagement::kFallTicks + (largest ? 14 : 1));
    EXPECT_EQ(Rig::largest(rig.tick()), 0.0);
    EXPECT_EQ(rig.controller.state(), State::kEngage);  // pressing the dead-man again is enough
  }
}

TEST(Controller, StopTakesTheForceAtOnce) {  // from the peak force: 3.3 N are seven steps of the step limit
  Rig rig;
  rig.to_force();
  rig.pull_hard();
  rig.controller.command(rt::CommandKind::kStop);
  EXPECT_EQ(Rig::largest(rig.tick()), 0.0);
  rig.tick();
  EXPECT_EQ(rig.controller.state(), State::kIdle);
}

TEST(Controller, ForceGrowsByAStepAtMost) {
  Rig rig;
  rig.to_force();
  rig.offset_m = 50.0;
  Vec3 before = rig.controller.hand(0).f_device_N;
  for (int i = 0; i < 100; ++i) {
    rig.tick();
    const Vec3 now = rig.controller.hand(0).f_device_N;
    EXPECT_LE((now - before).norm(), device::omni().force_step_N);
    before = now;
  }
}

TEST(Controller, AHandThatIsTooFastIsBrakedAndMayComeBack) {  // the speed limit, below the velocity fault
  Rig rig;
  rig.to_force();
  const double step = 2.4e-3 / 0.192;  // 2.4 m/s at the waist's lever arm: above the limit, below the fault
  bool braked = false, seen = false;
  for (int i = 0; i < 8; ++i) {
    rig.in.reading.hand[0].q_rad[0] += i < 4 ? step : 0.0;
    rig.tick();
    braked = braked || rig.controller.state() == State::kBrake;
    seen = seen || (rig.controller.hand(0).limits & rt::kVelocityBrake) != 0;
  }
  EXPECT_TRUE(braked);
  EXPECT_TRUE(seen);
  EXPECT_EQ(rig.controller.fault(), Fault::kNone);
  rig.ticks(1000);
  EXPECT_EQ(rig.controller.state(), State::kForce);
}

TEST(Controller, TheBrakePushesAgainstTheMotion) {  // the hand keeps its speed while the coupling's reference is braked
  Rig rig;
  rig.to_force();
  double against_N = 0.0, with_N = 0.0;
  for (int i = 0; i < 20; ++i) {
    rig.in.reading.hand[0].q_rad[0] += 2.4e-3 / 0.192;
    rig.tick();
    if (rig.controller.state() != State::kBrake) continue;
    const HandState& hand = rig.controller.hand(0);
    const double along_N = hand.f_device_N.dot(hand.v_WT.normalized());
    against_N = std::max(against_N, -along_N);
    with_N = std::max(with_N, along_N);
  }
  EXPECT_GT(against_N, 0.3);
  EXPECT_LT(with_N, 0.02);
}

/// The loop stalled while samples were requested, so the sample time is unknown: positions are valid, no velocity may
/// be derived.
TEST(Controller, ASampleOfUnknownTimeTellsNoSpeed) {
  Rig rig;
  rig.to_force();
  const auto turn = [&](double by_rad) {
    for (auto& hand : rig.in.reading.hand) hand.q_rad[0] += by_rad;
    rig.tick();
    return rig.controller.hand(0).v_WT.norm();
  };
  for (int i = 0; i < 20; ++i) turn(1e-3);
  const double speed = turn(1e-3);
  ASSERT_GT(speed, 0.0);
  rig.in.late = true;
  EXPECT_EQ(turn(15e-3), 0.0);  // 15 periods of motion in one sample
  rig.in.late = false;
  rig.in.tick += 15;
  EXPECT_NEAR(turn(1e-3), speed / 16.0, 1e-2 * speed) << "nothing before it counts, but it does";
  EXPECT_EQ(rig.controller.fault(), Fault::kNone);
}

/// With unknown sample times the encoder watch must stay silent: a corner in the position curve may be a timing error.
TEST(Controller, SamplesOfUnknownTimeAccuseNoEncoder) {
  for (const bool late : {false, true}) {
    Rig rig;
    rig.to_force();
    const double count = device::omni().rad_per_count();
    for (int i = 0; i < 200 && rig.controller.fault() == Fault::kNone; ++i) {
      for (auto& hand : rig.in.reading.hand) {
        hand.q_rad[0] += 1.0 * count;
        hand.q_rad[1] += (i < 100 ? 1.5 : -1.5) * count;  // reverses within one sample
      }
      rig.in.late = late && i % 20 == 0;
      rig.tick();
    }
    EXPECT_EQ(rig.controller.fault(), late ? Fault::kNone : Fault::kAxisReversed);
    EXPECT_EQ(rig.controller.culprit(), late ? rt::Culprit{} : (rt::Culprit{0, 1, 0})) << "left hand, shoulder";
  }
}

TEST(Controller, TheClutchParksTheToolAndReleasesItWhereItIs) {
  Rig rig;
  rig.in.reading.hand[0].grip = true;
  rig.to_force();
  const Vec3 parked = rig.controller.tools()[0].p_WT;
  rig.in.reading.hand[0].clutch = true;
  rig.in.reading.hand[0].grip = false;
  double before = rig.controller.hand(0).f_device_N.norm();
  for (int i = 0; i < 200; ++i) {
    rig.in.reading.hand[0].q_rad[1] += 0.0005;
    rig.tick();
    const double now = rig.controller.hand(0).f_device_N.norm();
    EXPECT_LE(now, before + 1e-12);  // decreases monotonically
    before = now;
  }
  EXPECT_EQ(before, 0.0);
  EXPECT_EQ(rig.controller.tools()[0].p_WT, parked);
  EXPECT_TRUE(rig.controller.tools()[0].grip);
  rig.in.reading.hand[0].clutch = false;
  rig.in.reading.hand[0].grip = true;
  for (int i = 0; i < 1000; ++i) {
    rig.tick();
    const double now = rig.controller.hand(0).f_device_N.norm();
    EXPECT_LE(std::abs(now - before), 0.5 / 500 + 2e-3);  // one step of the gain's ramp plus one torque quantum
    before = now;
  }
  EXPECT_LT((rig.controller.tools()[0].p_WT - parked).norm(), 1e-12);
  EXPECT_GT(before, 0.0);
}

TEST(Controller, TheClutchIsAlsoACommand) {
  Rig rig;
  rig.to_force();
  rig.controller.command(rt::CommandKind::kClutchRight);
  rig.tick();
  EXPECT_TRUE(rig.controller.hand(1).clutch);
  EXPECT_FALSE(rig.controller.hand(0).clutch);
  rig.controller.command(rt::CommandKind::kUnclutchRight);
  rig.tick();
  EXPECT_FALSE(rig.controller.hand(1).clutch);
}

TEST(Controller, AHandThatIsGoneLetsGoOfTheThread) {
  Rig rig;
  rig.in.reading.hand[0].grip = rig.in.reading.hand[1].grip = true;
  rig.to_force();
  EXPECT_TRUE(rig.controller.tools()[0].grip);
  for (int age = 1; age <= kWatchdog; ++age) {
    rig.in.reading.hand[0].age_ticks = age;
    rig.tick();
  }
  EXPECT_FALSE(rig.controller.tools()[0].grip);
  EXPECT_TRUE(rig.controller.tools()[1].grip);
}

TEST(Controller, ShutsDownWithARampAndSwitchesTheDrivesOff) {
  Rig rig;
  rig.to_force();
  double before = Rig::largest(rig.tick());
  rig.controller.shut_down();
  int ticks = 0;
  for (rt::RigCommand c; !rig.controller.is_finished(); ++ticks) {
    c = rig.tick();
    EXPECT_LE(Rig::largest(c), before);
    before = Rig::largest(c);
    ASSERT_LT(ticks, 100);
  }
  EXPECT_EQ(before, 0.0);
  EXPECT_GE(ticks, Engagement::kFallTicks);
  EXPECT_EQ(rig.tick().hand[0].request, rt::DriveRequest::kHold);
}

TEST(Controller, ShutsDownOutOfEveryEarlierState) {
  for (const int after : {0, 1, 30, 60, 100, 300}) {
    Rig rig;
    rig.ticks(after);
    rig.controller.shut_down();
    rig.ticks(100);
    EXPECT_TRUE(rig.controller.is_finished()) << "after " << after << " ticks";
  }
}

}  // namespace
}  // namespace ligature::control
