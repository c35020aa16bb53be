// The whole control law on made-up readings: the way to force, every fault's way to zero, and the ways back.
#include "firmware/control/controller.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

namespace ligature::control {
namespace {

constexpr int kWatchdog = 20;
constexpr double kStay_Nm = 0.7 * 0.3e-3 * (1 + 1e-9);  // torques are whole per mille of 0.3 N m, and stay within that

/// A rig whose hands rest while each holds a node 5 cm above it.
class Rig {
 public:
  Rig() : controller(scene(), {kWatchdog, true}) {
    for (std::size_t h = 0; h < rt::kHands; ++h) {
      auto& r = in.reading.hand[h];
      r.q_rad = {0.0, 0.5, 0.6};
      r.valid = r.enabled = r.dead_man = true;
      in.grasp[h].held = true;
    }
  }

  static scene::Hands scene() {
    scene::Hands hands;
    hands.workspace_scale = 20.0;
    hands.energy_credit_J = 0.02;  // these hands never move, and earn nothing
    return hands;
  }

  rt::RigCommand tick() {
    for (std::size_t h = 0; h < rt::kHands; ++h) in.grasp[h].p_WG = controller.hand(h).p_WT + Vec3(0, 0, offset_m);
    const auto command = controller.tick(in);
    ++in.tick;
    return command;
  }
  void ticks(int n) {
    for (int i = 0; i < n; ++i) tick();
  }
  void to_force() {
    ticks(1000);
    ASSERT_EQ(controller.state(), State::kForce);
    ASSERT_GT(largest(tick()), 0.0);
  }
  static double largest(const rt::RigCommand& c) {
    double most = 0.0;
    for (const auto& hand : c.hand) {
      for (const double t : hand.torque_Nm) most = std::max(most, std::abs(t));
    }
    return most;
  }

  Controller controller;
  TickInput in;
  double offset_m = 0.05;
};

TEST(Controller, ComesUpThroughEveryStateToForce) {
  Rig rig;
  std::vector<State> seen{rig.controller.state()};
  for (int i = 0; i < 1000; ++i) {
    rig.tick();
    if (rig.controller.state() != seen.back()) seen.push_back(rig.controller.state());
  }
  EXPECT_EQ(seen, (std::vector{State::kOff, State::kCalibrate, State::kIdle, State::kEngage, State::kForce}));
}

TEST(Controller, FeelsTheCouplingThroughTheLinkage) {  // 1200 N/m x 0.05 m x 0.003 = 0.18 N upwards on both hands
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
  Rig rig;
  rig.to_force();
  rig.offset_m = 50.0;
  rig.ticks(40);  // 0.15 N a tick
  EXPECT_TRUE(rig.controller.hand(0).limits & rt::kPeakLimit);
  EXPECT_NEAR(rig.controller.hand(0).f_device_N.norm(), 3.3, 1e-9);
  EXPECT_LE(rig.controller.hand(0).f_device_N.norm(), 3.3);
  EXPECT_TRUE(rig.controller.hand(0).limited);
  EXPECT_EQ(rig.controller.fault(), Fault::kNone);  // a limit is not a fault
}

TEST(Controller, AForceBelowTheLimitIsNotCalledLimited) {  // while the gain still rises, or without arming
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

TEST(Controller, ReleasedDeadManTakesTheForceInFiftyMilliseconds) {
  Rig rig;
  rig.to_force();
  rig.in.reading.hand[0].dead_man = rig.in.reading.hand[1].dead_man = false;
  rig.ticks(Engagement::kFallTicks + 1);
  EXPECT_EQ(Rig::largest(rig.tick()), 0.0);
  EXPECT_EQ(rig.controller.state(), State::kEngage);  // pressing again is enough
}

TEST(Controller, StopTakesTheForceAtOnce) {
  Rig rig;
  rig.to_force();
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

TEST(Controller, AHandThatIsTooFastIsBrakedAndMayComeBack) {  // a limit, not a fault
  Rig rig;
  rig.to_force();
  const double step = 2.4e-3 / 0.192;  // 2.4 m/s at the waist's lever: between limit and fault
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

TEST(Controller, TheBrakePushesAgainstTheMotion) {  // of a hand that goes on as fast: the reference stops, it does not
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
    EXPECT_LE(now, before + 1e-12);  // only less
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
    EXPECT_LE(std::abs(now - before), 0.5 / 500 + 2e-3);  // the ramp's step, and a quantum
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

struct Case {
  Fault fault;
  std::function<void(Rig&)> cause;
};

const std::vector<Case>& cases() {
  static const std::vector<Case> all{
      {Fault::kBusLost, [](Rig& r) { r.in.reading.hand[0].bus_lost = true; }},
      {Fault::kDriveFault, [](Rig& r) { r.in.reading.hand[1].drive_fault = true; }},
      {Fault::kDriveFault, [](Rig& r) { r.in.reading.hand[1].enabled = false; }},
      {Fault::kNonFinite, [](Rig& r) { r.offset_m = std::numeric_limits<double>::quiet_NaN(); }},
      {Fault::kVelocityLimit, [](Rig& r) { r.in.reading.hand[0].q_rad[0] += 0.2; }},  // 0.15 rad in 1 ms
      {Fault::kOverrun, [](Rig& r) { r.in.tick += kWatchdog; }},
      {Fault::kPhysicsDiverged, [](Rig& r) { r.in.thread_finite = false; }},
  };
  return all;
}

TEST(ControllerFaults, EachTakesAllTorqueInTheSameTickAndLatches) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(name(c.fault));
    Rig rig;
    rig.to_force();
    c.cause(rig);
    const auto command = rig.tick();
    EXPECT_EQ(rig.controller.state(), State::kFault);
    EXPECT_EQ(rig.controller.fault(), c.fault);
    EXPECT_EQ(Rig::largest(command), 0.0);
    for (const auto& hand : command.hand) EXPECT_EQ(hand.request, rt::DriveRequest::kHold);  // and the power stages off

    Rig healthy;  // the cause is gone; the fault is not
    rig.in.reading = healthy.in.reading;
    rig.in.thread_finite = true;
    rig.offset_m = 0.05;
    rig.controller.command(rt::CommandKind::kArm);
    for (int i = 0; i < 100; ++i) EXPECT_EQ(Rig::largest(rig.tick()), 0.0);
    EXPECT_EQ(rig.controller.fault(), c.fault);
  }
}

/// Its drive says that it makes what was asked of it once, whatever is asked now: no step back from that may be sent
/// without a jump, and without a limit of time force stood for ever.
TEST(ControllerFaults, AForceThatDoesNotEndIsTakenAtOnce) {
  for (const bool by_dead_man : {false, true}) {
    Rig rig;
    rig.to_force();
    rig.offset_m = 50.0;
    rig.ticks(40);
    const auto asked = rig.tick();
    ASSERT_GT(rig.controller.hand(0).f_device_N.norm(), 3.0);
    for (std::size_t j = 0; j < rt::kJoints; ++j) rig.in.reading.hand[0].torque_Nm[j] = asked.hand[0].torque_Nm[j];
    if (by_dead_man)
      rig.in.reading.hand[0].dead_man = false;
    else
      rig.controller.command(rt::CommandKind::kDisarm);
    int ticks = 0;
    for (; ticks < 1000 && rig.controller.fault() == Fault::kNone; ++ticks) rig.tick();
    EXPECT_EQ(rig.controller.fault(), Fault::kForceStays) << by_dead_man;
    EXPECT_LE(ticks, Engagement::kFallTicks + Controller::kMostOvertimeTicks + 2);
    EXPECT_EQ(Rig::largest(rig.tick()), 0.0);
    EXPECT_EQ(rig.controller.state(), State::kFault);
  }
}

TEST(ControllerFaults, OldJointMessagesAreHeldAndThenAFault) {
  Rig rig;
  rig.to_force();
  for (int age = 1; age < kWatchdog; ++age) {
    rig.in.reading.hand[0].age_ticks = age;
    rig.tick();
    ASSERT_EQ(rig.controller.fault(), Fault::kNone) << age;
  }
  rig.in.reading.hand[0].age_ticks = kWatchdog;
  const auto command = rig.tick();
  EXPECT_EQ(rig.controller.fault(), Fault::kTpdoTooOld);
  EXPECT_EQ(Rig::largest(command), 0.0);
}

TEST(ControllerFaults,
     ALostPeriodMakesNoOldSampleNew) {  // sets of 3 and 4 missing, period 5 lost: still the sample of 2
  Rig rig;
  rig.to_force();
  for (const int age : {1, 2}) {
    rig.in.reading.hand[0].age_ticks = age;
    rig.tick();
  }
  ++rig.in.tick;  // lost
  rig.in.reading.hand[0].age_ticks = 3;
  rig.tick();
  EXPECT_EQ(rig.controller.hand(0).age_ticks, 4);
}

TEST(ControllerFaults, OnlyAResetLeadsBackAndItArmsNothing) {
  Rig rig;
  rig.to_force();
  rig.in.reading.hand[0].drive_fault = true;
  rig.tick();
  rig.in.reading.hand[0].drive_fault = false;
  rig.controller.command(rt::CommandKind::kResetFault);
  EXPECT_EQ(rig.tick().hand[0].request, rt::DriveRequest::kEnable);
  rig.ticks(1000);
  EXPECT_EQ(rig.controller.state(), State::kIdle);
  EXPECT_EQ(rig.controller.fault(), Fault::kNone);
  EXPECT_FALSE(rig.controller.armed());
  rig.controller.command(rt::CommandKind::kArm);
  rig.to_force();
}

/// An encoder jumps and comes back: the work that seems to have been given is booked, what seems to have come is not,
/// and the hand had no force any more until the program was started again.
TEST(ControllerFaults, AResetBeginsTheAccountsAnew) {
  Rig rig;
  rig.to_force();
  for (const double jump_rad : {-100.0, 100.0}) {
    rig.in.reading.hand[0].q_rad[1] += jump_rad;
    rig.tick();
  }
  ASSERT_EQ(rig.controller.fault(), Fault::kVelocityLimit);
  rig.ticks(50);
  ASSERT_LT(rig.controller.hand(0).port_energy_J, -0.1);
  rig.controller.command(rt::CommandKind::kResetFault);
  rig.tick();
  EXPECT_DOUBLE_EQ(rig.controller.hand(0).port_energy_J, Rig::scene().energy_credit_J);
  rig.controller.command(rt::CommandKind::kArm);
  rig.to_force();
  EXPECT_GT(rig.controller.hand(0).f_device_N.norm(), 0.1);
}

TEST(ControllerFaults, AResetWhileTheCauseLastsFaultsAgain) {
  Rig rig;
  rig.to_force();
  rig.in.reading.hand[0].bus_lost = true;
  rig.tick();
  rig.controller.command(rt::CommandKind::kResetFault);
  rig.ticks(2);
  EXPECT_EQ(rig.controller.fault(), Fault::kBusLost);
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
