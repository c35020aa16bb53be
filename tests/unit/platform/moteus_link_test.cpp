// How moteus drives are switched on and off, and what their answers mean, with hand-made frames.
#include <cmath>
#include <limits>
#include <numbers>

#include "tests/unit/platform/moteus_hand_made.hpp"

namespace ligature::platform {
namespace {

TEST_F(Moteus, TakesRevolutionsTorqueAndButtons) {
  made_Nm = 0.125F;
  switch_on();
  const auto r = period(DriveRequest::kOperate, 0.3);
  EXPECT_EQ(r.age_ticks, 0);
  EXPECT_TRUE(r.valid && r.enabled && r.dead_man);
  EXPECT_FALSE(r.drive_fault || r.grip);
  EXPECT_DOUBLE_EQ(r.q_rad[1], std::numbers::pi) << "half a turn";
  EXPECT_EQ(r.measured_Nm[2], 0.125);
  EXPECT_TRUE(std::isnan(r.torque_Nm[0])) << "a measured torque is not the one that acts, to the last digit";
  EXPECT_EQ(sent, (std::array<std::int16_t, 3>{1000, 1000, 1000}));
  EXPECT_EQ(bus.sent[1], moteus::torque(2, 0.3F, {0.9F, 0.02F}));
}

/// A drive gets no torque before it has told back everything that it was commanded, and none after another answer: it
/// may have started anew, or have lost the command.
TEST_F(Moteus, NoTorqueUnlessEverySettingIsToldBack) {
  for (std::size_t i = 0; i < moteus::kExtras; ++i) {
    for (const bool later : {false, true}) {
      link.emplace(bus, device, kWatchdog_ms);
      const auto wrong = static_cast<moteus::Extra>(i);
      change = nullptr;
      set_modes(kOff);
      periods(10, DriveRequest::kHold);
      if (later) switch_on();
      change = [&](unsigned node, moteus::Extra extra) { return node == 2 && extra == wrong ? 0.5F : told(extra); };
      set_modes(kOff);
      if (!later) periods(3, DriveRequest::kEnable);
      set_modes(kOn);
      for (int k = 0; k < 30; ++k) {
        const auto r = period(later ? DriveRequest::kOperate : DriveRequest::kEnable, 0.3);
        ASSERT_FALSE(r.enabled && !later) << i;
        ASSERT_TRUE(all_stopped() || !r.drive_fault) << i;
        if (r.drive_fault) break;
        ASSERT_LT(k, 12) << i << later;
        EXPECT_TRUE(later || sent[0] == 0);
      }
    }
  }
}

TEST_F(Moteus, NoTorqueInTheFirstPeriodsWhateverIsAsked) {
  set_modes(kOff);
  periods(3, DriveRequest::kEnable);
  set_modes(kPreparing);
  for (int k = 0; k < 5; ++k) {
    EXPECT_FALSE(period(DriveRequest::kOperate, 0.3).enabled);
    EXPECT_EQ(sent[0], 0);
    EXPECT_EQ(bus.sent[0], moteus::torque(1, 0.0F, {0.9F, 0.02F}));
  }
  set_modes(kOn);
  for (int k = 0; k < 5; ++k) {
    (void)period(DriveRequest::kEnable);
    EXPECT_FALSE(link->reading().enabled) << "only some of the settings are told back";
  }
  EXPECT_TRUE(period(DriveRequest::kEnable).enabled);
  EXPECT_EQ(sent[0], 0) << "not before the control law wants to operate";
}

/// A drive that is on must say so in each answer. Any other mode is a fault at once, and all drives are stopped.
TEST_F(Moteus, AnyOtherModeIsAFaultAtOnce) {
  for (std::uint8_t other = 0; other <= 15; ++other) {
    if (other == kOn) continue;
    switch_on();
    (void)period(DriveRequest::kOperate, 0.3);
    mode[1] = other;
    const auto r = period(DriveRequest::kOperate, 0.3);
    EXPECT_TRUE(r.drive_fault) << int{other};
    EXPECT_EQ(r.bad_joint, 1) << int{other};
    EXPECT_TRUE(all_stopped()) << int{other};
    mode[1] = kOn;  // as if nothing had been
    EXPECT_FALSE(period(DriveRequest::kOperate, 0.3).enabled) << int{other};
    EXPECT_TRUE(all_stopped()) << int{other};
    set_modes(kOff);
    periods(60, DriveRequest::kHold);
  }
}

/// A drive that damps makes a torque that nobody commanded. That is the fault of its mode, which a reset clears.
TEST_F(Moteus, TheTorqueOfTheDampingIsNoTorqueAstray) {
  switch_on();
  made_Nm = 0.4F;
  mode[0] = kTimeout;
  const auto r = period(DriveRequest::kOperate);
  EXPECT_TRUE(std::isnan(r.measured_Nm[0]));
  EXPECT_NEAR(r.measured_Nm[1], 0.4, 1e-6);
  EXPECT_TRUE(r.drive_fault);
}

/// Also in an answer that is late, and so no sample.
TEST_F(Moteus, AnotherModeInALateAnswerIsAFault) {
  switch_on();
  bus.sent.clear();
  link->request();
  link->write({{}, DriveRequest::kOperate});
  link->request();
  bus.inbox.push_back(answer(2, kFixedVoltage, 0.0F, moteus::Extra::kHome, 1.0F));
  link->drain();
  EXPECT_GE(link->reading().age_ticks, 2);
  EXPECT_TRUE(link->reading().drive_fault);
}

TEST_F(Moteus, FaultsAreFaultsAndLimitsAreLimits) {
  for (int number = 1; number < 128; ++number) {
    switch_on();
    fault[2] = static_cast<std::uint8_t>(number);
    const auto r = period(DriveRequest::kOperate, 0.1);
    const bool is_limit = number >= 96 && number <= 103;
    EXPECT_EQ(r.drive_fault, !is_limit) << number;
    EXPECT_EQ(r.bad_joint, is_limit ? -1 : 2) << number;
    EXPECT_EQ(r.drive_error, is_limit ? 0U : static_cast<unsigned>(number));
    EXPECT_EQ(r.torque_limited[2], is_limit) << number;
    EXPECT_FALSE(r.torque_limited[1]);
    fault[2] = 0;
    set_modes(kOff);
    periods(60, DriveRequest::kHold);
  }
}

/// Only the answer to a query that came after the stop says that a drive is off.
TEST_F(Moteus, ADriveIsOffOnlyIfItSaysSoAfterTheStop) {
  for (const bool is_refused : {false, true}) {
    switch_on();
    (void)period(DriveRequest::kOperate, 0.3);
    set_modes(kOff);  // by themselves, before the stop
    bus.sent.clear();
    link->request();
    const auto extra = *asked();
    for (unsigned node = 1; node <= 3; ++node) bus.inbox.push_back(answer(node, kOff, rev, extra, told(extra)));
    press();
    link->drain();
    if (is_refused) bus.refuse_at = 1;  // the stop to node 2
    link->write({{}, DriveRequest::kHold});
    EXPECT_FALSE(link->nodes()[0].is_off);
    EXPECT_EQ(link->reading().bus_lost, is_refused);
    period(DriveRequest::kHold);
    EXPECT_TRUE(link->nodes()[0].is_off);
    EXPECT_EQ(link->nodes()[1].is_off, !is_refused) << "a refused stop is no stop";
    EXPECT_TRUE(all_stopped()) << "it is sent again";
    period(DriveRequest::kHold);
    EXPECT_TRUE(link->nodes()[1].is_off);
    periods(60, DriveRequest::kHold);
  }
}

/// A reset of the fault waits until all drives are off. Meanwhile they get stops, which feed no watchdog.
TEST_F(Moteus, AResetWaitsUntilAllDrivesAreOff) {
  switch_on();
  mode = {kOff, kTimeout, kOff};
  for (int k = 0; k < 80; ++k) {
    (void)period(k < 60 ? DriveRequest::kHold : DriveRequest::kEnable);
    EXPECT_TRUE(all_stopped()) << k;
  }
  switch_on();
}

TEST_F(Moteus, ADriveThatForgotItsPositionStaysOffUntilARestart) {
  switch_on();
  set_modes(kOff);
  periods(10, DriveRequest::kHold);
  change = [this](unsigned node, moteus::Extra extra) {
    return node == 3 && extra == moteus::Extra::kHome ? 2.0F : told(extra);
  };
  periods(6, DriveRequest::kHold);
  change = nullptr;
  for (int k = 0; k < 100; ++k) {
    EXPECT_TRUE(period(DriveRequest::kEnable).drive_fault) << k;
    ASSERT_TRUE(all_stopped()) << k;
  }
}

/// Without its torque a drive's own torque would not be seen.
TEST_F(Moteus, ATorqueThatIsNoNumberIsAstray) {
  constexpr std::array<bool, 3> kNoJoint{};
  switch_on();
  EXPECT_EQ(period(DriveRequest::kOperate).torque_astray, kNoJoint);
  made_Nm = std::nanf("");
  EXPECT_EQ(period(DriveRequest::kOperate).torque_astray, (std::array{true, true, true}));
  set_modes(kOff);
  EXPECT_EQ(period(DriveRequest::kHold).torque_astray, kNoJoint) << "a drive that is off makes none";
}

/// A drive whose encoder has failed still says its mode.
TEST_F(Moteus, WithoutAPositionTheModeCountsAndTheSampleDoesNot) {
  switch_on();
  rev = std::nanf("");
  for (int k = 0; k < 5; ++k) {
    const auto r = period(DriveRequest::kOperate);
    EXPECT_EQ(r.age_ticks, k + 1);
    EXPECT_DOUBLE_EQ(r.q_rad[0], std::numbers::pi);
    EXPECT_FALSE(r.drive_fault);
  }
  mode[1] = kFixedVoltage;
  EXPECT_TRUE(period(DriveRequest::kOperate).drive_fault);
  EXPECT_TRUE(all_stopped());
}

/// The honest answer must not become one to nothing.
TEST_F(Moteus, AFrameThatIsNoAnswerStrikesNoRequestOff) {
  switch_on();
  can::Frame other = answer(1, kOn, 0.0F, moteus::Extra::kHome, 1.0F);
  other.id |= can::kExtendedBit;
  for (const can::Frame& f : {other, can::Frame{0x100, 3, {0x21, 0x00, kOn}, can::Format::kFdFast}}) {
    bus.on_send = [&](const can::Frame& sent_now) {  // it comes after the query and before the answer
      if (sent_now.id == moteus::query(1, {}).id) bus.inbox.push_back(f);
    };
    const auto r = period(DriveRequest::kOperate);
    EXPECT_EQ(r.age_ticks, 0);
    EXPECT_FALSE(r.drive_fault);
  }
}

TEST_F(Moteus, ARefusedTorqueIsALostBus) {
  switch_on();
  bus.refuse_at = 4;  // of three queries and three torques
  (void)period(DriveRequest::kOperate, 0.3);
  EXPECT_EQ(sent, (std::array<std::int16_t, 3>{1000, 0, 1000}));
  EXPECT_TRUE(link->reading().bus_lost);
}

TEST_F(Moteus, FramesOfAnotherControllerStopTheDrives) {
  const auto to = [](std::uint32_t id, std::vector<std::uint8_t> bytes) {
    can::Frame f{id, static_cast<std::uint8_t>(bytes.size()), {}, can::Format::kFdFast};
    std::ranges::copy(bytes, f.data.begin());
    return f;
  };
  EXPECT_EQ(moteus::foreign_kind(moteus::torque(2, 0.1F, {})), rt::Foreign::kTorque);
  EXPECT_EQ(moteus::foreign_kind(moteus::query(2, {})), rt::Foreign::kBeat);
  EXPECT_EQ(moteus::foreign_kind(moteus::stop(2)), rt::Foreign::kNetwork);
  EXPECT_EQ(moteus::foreign_kind(to(0x501, {0x40, 0x01, 0x00})), rt::Foreign::kObject) << "a diagnostic text";
  EXPECT_EQ(moteus::foreign_kind(to(can::kExtendedBit | 0x827F, {0x0D})), rt::Foreign::kTorque) << "to all";
  EXPECT_EQ(moteus::foreign_kind(answer(1, kOn, 0.0F, {}, 0.0F)), rt::Foreign::kNone);
  EXPECT_EQ(moteus::foreign_kind({moteus::kButtonsId, 2, {}}), rt::Foreign::kNone);
  switch_on();
  bus.inbox.push_back(moteus::torque(2, 0.1F, {}));
  EXPECT_EQ(period(DriveRequest::kOperate, 0.3).foreign, rt::Foreign::kTorque);
  EXPECT_TRUE(all_stopped());
  set_modes(kOff);
  EXPECT_EQ(periods(100, DriveRequest::kEnable).foreign, rt::Foreign::kTorque);
  EXPECT_TRUE(all_stopped()) << "until a restart";
}

}  // namespace
}  // namespace ligature::platform
