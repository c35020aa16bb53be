// Tests that a fault, or a rig that stays in OFF or CALIBRATE, names its hand, its drive and the drive's error code.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <utility>

#include "tests/unit/control/controller_rig.hpp"

namespace ligature::control {
namespace {

constexpr rt::Culprit kNobody{};

/// The culprit after a tick in which something is wrong with a rig that had force.
template <class Cause>
rt::Culprit culprit_of(const Cause& cause) {
  Rig rig;
  rig.to_force();
  EXPECT_EQ(rig.controller.culprit(), kNobody);
  cause(rig);
  rig.tick();
  EXPECT_EQ(rig.controller.state(), State::kFault);
  return rig.controller.culprit();
}

TEST(Culprit, ADriveFaultNamesHandDriveAndError) {
  for (const std::int8_t hand : std::array<std::int8_t, 2>{0, 1}) {
    for (const std::int8_t joint : std::array<std::int8_t, 3>{0, 1, 2}) {
      const rt::Culprit found = culprit_of([&](Rig& rig) {
        auto& reading = rig.in.reading.hand[static_cast<std::size_t>(hand)];
        reading.tell_drive(static_cast<std::size_t>(joint), {.has_failed = true, .error = 0x3210});
      });
      EXPECT_EQ(found, (rt::Culprit{hand, joint, 0x3210}));
    }
  }
}

TEST(Culprit, FaultsOfAHandNameTheHandAndThoseOfTheRigNobody) {
  const rt::Culprit left{.hand = 0}, right{.hand = 1};
  EXPECT_EQ(culprit_of([](Rig& rig) { rig.in.reading.hand[1].bus_lost = true; }), right);
  EXPECT_EQ(culprit_of([](Rig& rig) { rig.in.reading.hand[1].foreign = rt::Foreign::kBeat; }), right);
  EXPECT_EQ(culprit_of([](Rig& rig) { rig.in.reading.hand[0].buttons_stuck = true; }), left);
  EXPECT_EQ(culprit_of([](Rig& rig) { rig.in.thread_finite = false; }), kNobody);
  EXPECT_EQ(culprit_of([](Rig& rig) { rig.in.tick += kWatchdog; }), kNobody);
}

TEST(Culprit, OfOldMessagesIsTheDriveThatDoesNotAnswer) {
  Rig rig;
  rig.to_force();
  auto& reading = rig.in.reading.hand[1];
  reading.tell_drive(2, {.is_silent = true});
  for (reading.age_ticks = 1; reading.age_ticks <= kWatchdog; ++reading.age_ticks) rig.tick();
  EXPECT_EQ(rig.controller.fault(), Fault::kTpdoTooOld);
  EXPECT_EQ(rig.controller.culprit(), (rt::Culprit{1, 2, 0}));
}

TEST(Culprit, AResetForgetsIt) {
  Rig rig;
  rig.to_force();
  rig.in.reading.hand[0].buttons_stuck = true;
  rig.tick();
  rig.in.reading.hand[0].buttons_stuck = false;
  rig.ticks(100);
  EXPECT_EQ(rig.controller.culprit(), rt::Culprit{.hand = 0}) << "as long as the fault";
  rig.controller.command(rt::CommandKind::kResetFault);
  rig.tick();
  EXPECT_EQ(rig.controller.culprit(), kNobody);
}

TEST(Culprit, InOffIsTheDriveThatIsNotOnAndInCalibrateTheHandWithoutAPose) {
  Rig rig;
  rig.in.reading.hand[1].tell_drive(1, {.is_on = false});
  rig.ticks(10);
  ASSERT_EQ(rig.controller.state(), State::kOff);
  EXPECT_EQ(rig.controller.culprit(), (rt::Culprit{1, 1, 0}));
  Rig posed;
  posed.in.reading.hand[0].q_rad[1] = 50.0;  // no pose of the device
  posed.ticks(100);
  ASSERT_EQ(posed.controller.state(), State::kCalibrate);
  EXPECT_EQ(posed.controller.culprit(), rt::Culprit{.hand = 0});
}

TEST(Culprit, OfARigThatShutsDownIsNobody) {
  Rig rig;
  rig.in.reading.hand[0].enabled = false;
  rig.controller.shut_down();
  rig.ticks(10);
  EXPECT_EQ(rig.controller.culprit(), kNobody);
}

TEST(Culprit, OfSeveralDrivesIsTheOneInTheWorstTroubleAndThenTheOneWithAnErrorCode) {
  rt::HandReading reading;
  const auto after = [&](std::size_t joint, const rt::DriveStatus& drive) {
    reading.tell_drive(joint, drive);
    return std::pair(int{reading.bad_joint}, reading.drive_error);
  };
  EXPECT_EQ(after(2, {}), std::pair(-1, 0U)) << "no trouble";
  EXPECT_EQ(after(2, {.error = 0x1000}), std::pair(-1, 0U)) << "an error that is over";
  EXPECT_EQ(after(0, {.is_on = false}), std::pair(0, 0U));
  EXPECT_EQ(after(1, {.is_on = false}), std::pair(0, 0U)) << "the first of equal ones";
  EXPECT_EQ(after(2, {.is_silent = true}), std::pair(2, 0U)) << "the worst";
  EXPECT_EQ(after(0, {.is_on = false, .error = 0x1000}), std::pair(2, 0U));
  EXPECT_EQ(after(1, {.is_silent = true, .error = 0x8130}), std::pair(1, 0x8130U)) << "the first with a code";
  EXPECT_EQ(after(2, {.is_silent = true, .error = 0x5113}), std::pair(1, 0x8130U));
  EXPECT_FALSE(reading.drive_fault);
  EXPECT_EQ(after(2, {.has_failed = true}), std::pair(2, 0U)) << "its own code, or none";
  EXPECT_TRUE(reading.drive_fault);
}

}  // namespace
}  // namespace ligature::control
