// After the force was removed, only a new press of the hand's dead-man brings it back, never a command alone.
#include "firmware/control/dead_man.hpp"

#include "tests/unit/control/controller_rig.hpp"

namespace ligature::control {
namespace {

constexpr int kLong = 2000;  // ticks; four times as long as the rise to full force takes

TEST(DeadMan, CountsAfterItWasSeenReleased) {
  DeadMan d;
  for (int i = 0; i < 100; ++i) d.see(true);
  EXPECT_FALSE(d.counts());
  for (int i = 0; i < DeadMan::kReleased - 1; ++i) d.see(false);  // too short for a release: a few wrong bits
  d.see(true);
  EXPECT_FALSE(d.counts());
  for (int i = 0; i < DeadMan::kReleased; ++i) d.see(false);
  EXPECT_FALSE(d.counts());
  d.see(true);
  EXPECT_TRUE(d.counts());
  d.see(false);
  EXPECT_FALSE(d.counts());
  d.see(true);  // released for a moment and pressed again: no full release is needed now
  EXPECT_TRUE(d.counts());
}

TEST(DeadMan, AReleaseBeforeTheForceWasTakenDoesNotCount) {
  DeadMan d;
  for (int i = 0; i < 100; ++i) d.see(false);
  d.need_new_press();
  d.see(true);
  EXPECT_FALSE(d.counts());
}

void expect_no_force(Rig& rig, int ticks = kLong) {
  for (int i = 0; i < ticks; ++i) ASSERT_EQ(Rig::largest(rig.tick()), 0.0) << "tick " << i;
  EXPECT_EQ(rig.controller.hand(0).gain, 0.0);
}

void press_anew(Rig& rig) {
  rig.released = 0;
  rig.to_force();
}

TEST(NewPress, AfterAStop) {  // a dead-man held all along must not give force with the next `arm`
  Rig rig;
  rig.to_force();
  rig.controller.command(rt::CommandKind::kStop);
  rig.ticks(10);
  rig.controller.command(rt::CommandKind::kArm);
  expect_no_force(rig);
  EXPECT_EQ(rig.controller.state(), State::kEngage);
  EXPECT_TRUE(rig.controller.hand(0).dead_man) << "the button is recorded as it is";
  press_anew(rig);
}

TEST(NewPress, AfterAStopThatTookNothing) {  // a stop when there was no force counts as well
  Rig rig;
  rig.controller.command(rt::CommandKind::kDisarm);
  rig.ticks(100);
  rig.controller.command(rt::CommandKind::kStop);
  rig.tick();
  rig.controller.command(rt::CommandKind::kArm);
  expect_no_force(rig);
  press_anew(rig);
}

TEST(NewPress, OfEachHandByItself) {
  Rig rig;
  rig.to_force();
  rig.controller.command(rt::CommandKind::kStop);
  rig.in.reading.hand[0].dead_man = false;
  rig.ticks(DeadMan::kReleased);
  rig.in.reading.hand[0].dead_man = true;
  rig.controller.command(rt::CommandKind::kArm);
  rig.ticks(kLong);
  EXPECT_GT(rig.controller.hand(0).f_device_N.norm(), 0.1);
  EXPECT_EQ(rig.controller.hand(1).f_device_N.norm(), 0.0);
}

TEST(NewPress, AfterAFaultsReset) {
  for (const bool pressed_while_in_fault : {false, true}) {
    Rig rig;
    rig.to_force();
    rig.in.reading.hand[0].drive_fault = true;
    rig.ticks(10);
    rig.in.reading.hand[0].drive_fault = false;
    if (pressed_while_in_fault) rig.released = 0;  // a press before the reset does not count for the force after it
    rig.ticks(100);
    rig.controller.command(rt::CommandKind::kResetFault);
    rig.ticks(100);
    rig.controller.command(rt::CommandKind::kArm);
    expect_no_force(rig);
    press_anew(rig);
  }
}

TEST(NewPress, OfAButtonHeldSinceTheStart) {
  Rig rig;
  rig.released = DeadMan::kReleased;
  expect_no_force(rig);
  EXPECT_EQ(rig.controller.state(), State::kEngage);
  press_anew(rig);
}

TEST(NewPress, IsSeenInFreshSamplesOnly) {  // while no new sample arrives, the last one is repeated; it counts once
  Rig rig;
  rig.to_force();
  rig.controller.command(rt::CommandKind::kStop);
  rig.tick();
  rig.in.reading.hand[0].dead_man = false;
  for (int age = 0; age < 10; ++age) {
    rig.in.reading.hand[0].age_ticks = age;
    rig.tick();
  }
  rig.in.reading.hand[0].dead_man = true;
  rig.in.reading.hand[0].age_ticks = 0;
  rig.controller.command(rt::CommandKind::kArm);
  expect_no_force(rig);
}

// Samples that always come the same number of periods late are fresh, too; otherwise a release would be ignored.
TEST(LetGo, IsSeenInSamplesThatComeLate) {
  for (int age = 0; age <= 3; ++age) {
    Rig rig;
    rig.to_force();
    for (auto& hand : rig.in.reading.hand) hand.age_ticks = age;
    rig.ticks(100);
    ASSERT_GT(Rig::largest(rig.tick()), 0.0) << age;
    for (auto& hand : rig.in.reading.hand) hand.dead_man = false;
    rig.ticks(150);
    EXPECT_EQ(Rig::largest(rig.tick()), 0.0) << age;
  }
}

TEST(LetGo, OfOneHandInALateSampleLeavesTheOther) {
  Rig rig;
  rig.to_force();
  rig.in.reading.hand[0].age_ticks = 1;
  rig.in.reading.hand[0].dead_man = false;
  rig.ticks(150);
  EXPECT_EQ(rig.controller.hand(0).gain, 0.0);
  EXPECT_EQ(rig.controller.hand(1).gain, 1.0);
}

TEST(NewPress, NotAfterADisarm) {  // no new press needed: the force returns through the gain, from zero
  Rig rig;
  rig.to_force();
  rig.controller.command(rt::CommandKind::kDisarm);
  rig.ticks(200);
  ASSERT_EQ(rig.controller.state(), State::kIdle);
  rig.controller.command(rt::CommandKind::kArm);
  rig.ticks(Engagement::kCalmTicks);
  EXPECT_LT(rig.controller.hand(0).gain, 0.01);
  rig.to_force();
}

TEST(NewPress, AMoveIsNotBegunByAnOldOne) {
  Rig rig;
  for (auto& grasp : rig.in.grasp) grasp.held = false;
  rig.ticks(1000);
  rig.controller.command(rt::CommandKind::kStop);
  rig.ticks(10);
  rig.controller.command(rt::CommandKind::kArm);
  rig.ticks(100);
  rig.controller.command(rt::CommandKind::kCalibrate);
  rig.released = 0;  // nor does a new press start the calibration's motion
  for (int i = 0; i < kLong; ++i) ASSERT_EQ(Rig::largest(rig.tick()), 0.0) << "tick " << i;
}

}  // namespace
}  // namespace ligature::control
