// Tests that every fault of the controller removes the force, which faults can be reset, and how. The tests set the
// drives' readings.
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <vector>

#include "tests/unit/control/controller_rig.hpp"

namespace ligature::control {
namespace {

struct Case {
  Fault fault;
  std::function<void(Rig&)> cause;
};

const std::vector<Case>& cases() {
  static const std::vector<Case> all{
      {Fault::kBusLost, [](Rig& r) { r.in.reading.hand[0].bus_lost = true; }},
      {Fault::kDriveFault, [](Rig& r) { r.in.reading.hand[1].drive_fault = true; }},
      {Fault::kDriveFault, [](Rig& r) { r.in.reading.hand[1].enabled = false; }},
      {Fault::kButtonsStuck, [](Rig& r) { r.in.reading.hand[0].buttons_stuck = true; }},
      {Fault::kNonFinite, [](Rig& r) { r.offset_m = std::numeric_limits<double>::quiet_NaN(); }},
      {Fault::kVelocityLimit,  // all joints: one moving alone under torque would be reported as the others being frozen
       [](Rig& r) {
         for (double& q : r.in.reading.hand[0].q_rad) q += 0.2;
       }},
      {Fault::kOverrun, [](Rig& r) { r.in.tick += kWatchdog; }},
      {Fault::kPhysicsDiverged, [](Rig& r) { r.in.thread_finite = false; }},
      {Fault::kForeignTorque, [](Rig& r) { r.in.reading.hand[0].foreign = rt::Foreign::kTorque; }},
      {Fault::kForeignBeat, [](Rig& r) { r.in.reading.hand[1].foreign = rt::Foreign::kBeat; }},
      {Fault::kForeignNetwork, [](Rig& r) { r.in.reading.hand[0].foreign = rt::Foreign::kNetwork; }},
      {Fault::kForeignObject, [](Rig& r) { r.in.reading.hand[1].foreign = rt::Foreign::kObject; }},
  };
  return all;
}

TEST(ControllerFaults, EachTakesAllTorqueInTheSameTickAndLatches) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(name(c.fault));
    Rig rig;
    rig.to_force();
    rig.pull_hard();
    c.cause(rig);
    const auto command = rig.tick();
    EXPECT_EQ(rig.controller.state(), State::kFault);
    EXPECT_EQ(rig.controller.fault(), c.fault);
    EXPECT_EQ(Rig::largest(command), 0.0);
    const auto off = needs_restart(c.fault) ? rt::DriveRequest::kStop : rt::DriveRequest::kHold;
    for (const auto& hand : command.hand) EXPECT_EQ(hand.request, off);  // the drives' power stages are off

    Rig healthy;  // the cause is removed; the fault remains
    rig.in.reading = healthy.in.reading;
    rig.in.thread_finite = true;
    rig.offset_m = 0.05;
    rig.controller.command(rt::CommandKind::kArm);
    for (int i = 0; i < 100; ++i) EXPECT_EQ(Rig::largest(rig.tick()), 0.0);
    EXPECT_EQ(rig.controller.fault(), c.fault);
  }
}

/// Frames or torques of another sender on the bus are a fault in every state of the controller, armed or not.
TEST(ControllerFaults, SomebodyElseOnTheBusIsAFaultInEveryStateAndNoResetLeavesIt) {
  for (const int ticks : {0, 1, 30, 200, 1000}) {  // OFF, CALIBRATE, IDLE or rising force, FORCE
    for (const bool armed : {false, true}) {
      for (const bool by_torque : {false, true}) {
        Rig rig;
        if (!armed) rig.controller.command(rt::CommandKind::kDisarm);
        rig.ticks(ticks);
        const auto state = rig.controller.state();
        auto& hand = rig.in.reading.hand[0];
        if (by_torque)
          hand.torque_Nm = {0.0, 0.9, 0.0};
        else
          hand.foreign = rt::Foreign::kTorque;
        rig.ticks(by_torque ? 2 : 1);
        const auto fault = by_torque ? Fault::kTorqueAstray : Fault::kForeignTorque;
        ASSERT_EQ(rig.controller.fault(), fault) << name(state);
        EXPECT_EQ(rig.controller.culprit(), (rt::Culprit{0, static_cast<std::int8_t>(by_torque ? 1 : -1), 0}));
        hand.foreign = rt::Foreign::kNone;
        hand.torque_Nm = {0.0, 0.0, 0.0};
        rig.controller.command(rt::CommandKind::kResetFault);
        rig.controller.command(rt::CommandKind::kArm);
        for (int i = 0; i < 100; ++i) ASSERT_EQ(rig.tick().hand[1].request, rt::DriveRequest::kStop);
        EXPECT_EQ(rig.controller.fault(), fault);
        rig.controller.shut_down();
        rig.ticks(Controller::kPowerDownTicks);
        EXPECT_TRUE(rig.controller.is_finished()) << "a run can be ended";
      }
    }
  }
}

/// The drive keeps reporting the torque of one command, whatever is sent to it later. The controller then cannot reduce
/// the force in steps without a jump, so a time limit must end the force. The device file of this test tolerates any
/// torque error; otherwise the torque check would report a fault first.
TEST(ControllerFaults, AForceThatDoesNotEndIsTakenAtOnce) {
  device::Device vague = device::omni();
  vague.torque_tolerance_permille = vague.max_torque_permille;
  for (const bool by_dead_man : {false, true}) {
    Rig rig(Rig::scene(), vague);
    rig.to_force();
    rig.pull_hard();
    const auto asked = rig.tick();
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

TEST(ControllerFaults, ArmingInAFaultIsNotKeptForAfterIt) {
  Rig rig;
  rig.to_force();
  rig.in.thread_finite = false;
  rig.tick();
  rig.in.thread_finite = true;
  rig.controller.command(rt::CommandKind::kArm);
  rig.controller.command(rt::CommandKind::kResetFault);
  for (int i = 0; i < 1000; ++i) ASSERT_EQ(Rig::largest(rig.tick()), 0.0) << i;
  EXPECT_EQ(rig.controller.state(), State::kIdle);
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

/// Fault of a left hand whose samples stop for `pause` periods, come for `steady` ones, and then jump by 30 mm.
Fault fault_of_a_jump_after(int pause, int steady) {
  Rig rig;
  rig.to_force();
  for (int age = 1; age <= pause; ++age) {
    rig.in.reading.hand[0].age_ticks = age;
    rig.tick();
  }
  rig.in.reading.hand[0].age_ticks = 0;
  rig.ticks(steady);
  for (double& q : rig.in.reading.hand[0].q_rad) q += 0.2;
  EXPECT_EQ(Rig::largest(rig.tick()), 0.0) << "either fault takes the force";
  return rig.controller.fault();
}

TEST(ControllerFaults, AJumpSoonAfterAPauseIsToldFromAHandThatIsTooFast) {
  EXPECT_EQ(fault_of_a_jump_after(10, 1), Fault::kSamplesBurst);
  EXPECT_EQ(fault_of_a_jump_after(10, 10), Fault::kSamplesBurst);
  EXPECT_EQ(fault_of_a_jump_after(10, 12), Fault::kVelocityLimit) << "longer ago than it lasted";
  EXPECT_EQ(fault_of_a_jump_after(3, 1), Fault::kVelocityLimit) << "lost frames are no pause";
}

TEST(ControllerFaults,
     // Samples of ticks 3 and 4 are missing, period 5 is lost: the sample of tick 2 stays the latest.
     ALostPeriodMakesNoOldSampleNew) {
  Rig rig;
  rig.to_force();
  for (const int age : {1, 2}) {
    rig.in.reading.hand[0].age_ticks = age;
    rig.tick();
  }
  ++rig.in.tick;  // a lost period
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
  rig.released = 0;
  rig.to_force();
}

/// An encoder jumps and returns. The two jumps look like energy that the motors deliver and get back. The account
/// debits the first but does not credit the second, so without a reset of the account the hand would have no force
/// until the program restarts.
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
  rig.released = 0;
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

}  // namespace
}  // namespace ligature::control
