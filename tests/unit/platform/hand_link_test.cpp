// One hand's cyclic traffic against frames made by hand: sets, ages, drive states, trouble.
#include "firmware/platform/hand_link.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "firmware/platform/rig_bus.hpp"
#include "protocol/can/emcy.hpp"
#include "protocol/can/heartbeat.hpp"
#include "protocol/can/nmt.hpp"
#include "protocol/can/sdo.hpp"
#include "protocol/can/units.hpp"
#include "tests/unit/platform/fake_bus.hpp"

namespace ligature::platform {
namespace {

using can::cia402::State;
constexpr auto kNodes = can::profile::kJointNodes;

class HandLinkTest : public ::testing::Test {
 protected:
  void answer(std::size_t joint, State state = State::kOperationEnabled, std::int32_t counts = 100,
              std::uint16_t buttons = 0) {
    bus.inbox.push_back(can::encode(kNodes[joint], can::Tpdo1{can::cia402::statusword_of(state), counts, 0, buttons}));
  }
  void answer_all(State state = State::kOperationEnabled, std::int32_t counts = 100, std::uint16_t buttons = 0) {
    for (std::size_t j = 0; j < 3; ++j) answer(j, state, counts, buttons);
  }
  rt::HandReading period() {
    link.send_sync();
    answer_all();
    link.drain();
    return link.reading();
  }
  can::Rpdo1 last_rpdo(std::size_t joint) const {
    for (auto f = bus.sent.rbegin(); f != bus.sent.rend(); ++f) {
      if (const auto rpdo = can::decode_rpdo1(kNodes[joint], *f)) return *rpdo;
    }
    return {};
  }
  FakeBus bus;
  HandLink link{bus, device::omni()};
};

TEST_F(HandLinkTest, ACompleteSetIsFreshAndInSiUnits) {
  link.send_sync();
  answer_all(State::kOperationEnabled, 4096, can::profile::kButtonGrip | can::profile::kButtonDeadMan);
  EXPECT_FALSE(link.is_settled());
  link.drain();
  EXPECT_TRUE(link.is_settled());
  const auto r = link.reading();
  EXPECT_TRUE(r.valid && r.enabled && r.grip && r.dead_man);
  EXPECT_FALSE(r.drive_fault || r.bus_lost);
  EXPECT_EQ(r.age_ticks, 0);
  EXPECT_DOUBLE_EQ(r.q_rad[2], can::angle_rad(4096));
}

TEST_F(HandLinkTest, ButtonsWhoseLifeSignStandsStillAreStuck) {
  const auto answer_with_life = [this](std::uint8_t life) {
    link.send_sync();
    answer_all(State::kOperationEnabled, 100, can::profile::with_life(can::profile::kButtonDeadMan, life));
    link.drain();
    return link.reading();
  };
  for (std::uint8_t life = 0; life < 50; ++life) EXPECT_FALSE(answer_with_life(life).buttons_stuck);
  for (int i = 0; i < 9; ++i) EXPECT_FALSE(answer_with_life(49).buttons_stuck) << i;
  EXPECT_TRUE(answer_with_life(49).buttons_stuck);
  EXPECT_FALSE(answer_with_life(50).buttons_stuck);
}

TEST_F(HandLinkTest, ADriveWithoutALifeSignIsTakenAsItIs) {
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(period().buttons_stuck);
}

TEST_F(HandLinkTest, BusLoadIsThatOfThePeriodBefore) {  // SYNC, 3 TPDOs, 3 RPDOs: 617 .. 745 bits of 1000
  for (int i = 0; i < 3; ++i) {
    period();
    link.write({});
  }
  const auto load = period().bus_load;
  EXPECT_GE(load, 0.617F);
  EXPECT_LE(load, 0.745F);
}

TEST(HandLinkDevice, AnotherRecordIsAnotherScale) {
  FakeBus bus;
  device::Device d = device::omni();
  d.motor_counts = 1000;
  d.gear = 2.0;
  d.rated_torque_Nm = 0.05;
  HandLink link(bus, d);
  link.send_sync();
  for (std::size_t j = 0; j < 3; ++j)
    bus.inbox.push_back(
        can::encode(kNodes[j], can::Tpdo1{can::cia402::statusword_of(State::kOperationEnabled), 500, 0, 0}));
  link.drain();
  EXPECT_DOUBLE_EQ(link.reading().q_rad[0], std::acos(-1.0) / 2.0);  // a quarter of 2000 counts
  const auto sent = link.write({{0.025, -0.001, 9.0}, rt::DriveRequest::kOperate});
  EXPECT_EQ(sent, (std::array<std::int16_t, 3>{500, -20, 3000}));
}

TEST_F(HandLinkTest, TwoOfThreeAreNoPose) {  // the old set is held and its age counted
  period();
  link.send_sync();
  answer(0, State::kOperationEnabled, 999);
  answer(2, State::kOperationEnabled, 999);
  link.drain();
  EXPECT_FALSE(link.is_settled());
  EXPECT_EQ(link.reading().age_ticks, 1);
  EXPECT_DOUBLE_EQ(link.reading().q_rad[0], can::angle_rad(100));
}

TEST_F(HandLinkTest, AJointOfTheLastSyncMakesNoSetWithTwoOfThis) {  // a pose that never was
  period();
  link.send_sync();
  answer(0, State::kOperationEnabled, 999);
  link.drain();
  link.send_sync();
  answer(1, State::kOperationEnabled, 200);
  answer(2, State::kOperationEnabled, 200);
  link.drain();
  EXPECT_FALSE(link.is_settled());
  EXPECT_DOUBLE_EQ(link.reading().q_rad[0], can::angle_rad(100));
}

/// Whoever dropped out by itself is not brought back before somebody asks for it: that is kEnable.
TEST(HandLinkControlword, OperatingKeepsOnlyThoseUpThatAreUp) {
  for (const auto& p : can::cia402::kStatusPatterns) {
    const auto word = controlword(rt::DriveRequest::kOperate, p.state, can::cia402::kControlEnableOperation);
    EXPECT_EQ(word == can::cia402::kControlEnableOperation, p.state == State::kOperationEnabled);
    EXPECT_EQ(controlword(rt::DriveRequest::kHold, p.state, word), can::cia402::kControlDisableVoltage);
  }
}

TEST_F(HandLinkTest, ASetThatCameTooLateCountsAsOnePeriodOld) {
  period();
  link.send_sync();
  link.drain();
  answer_all(State::kOperationEnabled, 200);  // after the deadline
  link.send_sync();
  EXPECT_EQ(link.reading().age_ticks, 1);
  EXPECT_DOUBLE_EQ(link.reading().q_rad[0], can::angle_rad(200));
}

TEST_F(HandLinkTest, AgeGrowsByOneAPeriodOfSilence) {
  period();
  for (int age = 1; age < 5; ++age) {
    link.send_sync();
    EXPECT_EQ(link.reading().age_ticks, age);
  }
}

TEST_F(HandLinkTest, ADriveThatDropsOutOrFaultsIsSeen) {
  period();
  link.send_sync();
  answer(0);
  answer(1, State::kSwitchedOn);
  answer(2);
  link.drain();
  EXPECT_FALSE(link.reading().enabled);
  EXPECT_FALSE(link.reading().drive_fault);
  link.send_sync();
  answer(0);
  answer(1, State::kFault);
  answer(2);
  link.drain();
  EXPECT_TRUE(link.reading().drive_fault);
}

TEST_F(HandLinkTest, AnEmergencyCountsUntilItIsOver) {
  period();
  bus.inbox.push_back(can::encode(can::Emergency{kNodes[1], can::emcy::kRpdoTimeout, can::emcy::kGenericBit}));
  EXPECT_TRUE(period().drive_fault);
  bus.inbox.push_back(can::encode(can::Emergency{kNodes[1], can::emcy::kNoError, 0}));
  EXPECT_FALSE(period().drive_fault);
}

TEST_F(HandLinkTest, ANodeThatRebootedIsTrouble) {
  period();
  bus.inbox.push_back(can::encode(can::Heartbeat{kNodes[0], can::NmtState::kBootUp}));
  EXPECT_TRUE(period().drive_fault);
}

TEST_F(HandLinkTest, WhatOnlyAControllerSendsIsSeenForWhatItIs) {
  using rt::Foreign;
  const std::pair<can::Frame, Foreign> all[] = {
      {can::encode(can::kWaist, can::Rpdo1{can::cia402::kControlEnableOperation, 3000}), Foreign::kTorque},
      {{0x301, 8, {}}, Foreign::kTorque},  // RPDO 2 and 4, that a drive may have been delivered with
      {{0x503, 8, {}}, Foreign::kTorque},
      {can::sync_frame(), Foreign::kBeat},
      {{0x080, 1, {7}}, Foreign::kBeat},  // with a counter
      {can::encode(can::Heartbeat{can::kMasterNode, can::NmtState::kOperational}), Foreign::kBeat},
      {can::encode_nmt(can::NmtCommand::kStart), Foreign::kNetwork},
      {can::encode_nmt(can::NmtCommand::kResetNode, can::kElbow), Foreign::kNetwork},
      {{0x7E5, 8, {}}, Foreign::kNetwork},
      {can::sdo_read(can::kElbow, can::od::kStatusword), Foreign::kObject},
      {can::sdo_write(can::kElbow, can::od::kMaxTorque, 1, 2), Foreign::kObject}};
  for (const auto& [frame, kind] : all) {
    FakeBus own;
    HandLink hand(own, device::omni());
    hand.send_sync();
    EXPECT_EQ(hand.reading().foreign, Foreign::kNone);
    own.inbox.push_back(frame);
    hand.drain();
    EXPECT_EQ(hand.reading().foreign, kind) << frame.id;
    own.inbox.push_back(can::sync_frame());
    for (int i = 0; i < 3; ++i) hand.send_sync();
    EXPECT_EQ(hand.reading().foreign, kind) << "the first one, kept for the run";
  }
}

TEST_F(HandLinkTest, WhatDrivesSendIsNotForeign) {
  const can::Frame all[] = {can::encode(can::kWaist, can::Tpdo1{}),
                            {0x281, 8, {}},
                            {0x481, 8, {}},
                            can::encode(can::Emergency{can::kElbow, 0, 0}),
                            can::encode(can::Heartbeat{can::kElbow, can::NmtState::kOperational}),
                            can::encode(can::Sdo{can::SdoKind::kWritten, can::kElbow, can::od::kMaxTorque, 0, 0}),
                            {0x7E4, 8, {}}};
  for (const auto& frame : all) bus.inbox.push_back(frame);
  EXPECT_EQ(period().foreign, rt::Foreign::kNone);
}

TEST_F(HandLinkTest, ADriveThatSaysItsTorqueIsAstrayIsHeard) {
  EXPECT_FALSE(period().torque_astray);
  for (std::size_t astray = 0; astray < 3; ++astray) {
    link.send_sync();
    for (std::size_t j = 0; j < 3; ++j) {
      const std::uint16_t bit = j == astray ? can::cia402::kTorqueAstrayBit : std::uint16_t{0};
      const auto word = static_cast<std::uint16_t>(can::cia402::statusword_of(State::kOperationEnabled) | bit);
      bus.inbox.push_back(can::encode(kNodes[j], can::Tpdo1{word, 100, 0, 0}));
    }
    link.drain();
    EXPECT_TRUE(link.reading().torque_astray) << astray;
  }
  EXPECT_FALSE(period().torque_astray);
}

TEST_F(HandLinkTest, ADriveThatMakesLessThanItWasAskedForIsHeard) {
  for (std::size_t limited = 0; limited < 3; ++limited) {
    link.send_sync();
    for (std::size_t j = 0; j < 3; ++j) {
      const std::uint16_t bit = j == limited ? can::cia402::kInternalLimitBit : std::uint16_t{0};
      const auto word = static_cast<std::uint16_t>(can::cia402::statusword_of(State::kOperationEnabled) | bit);
      bus.inbox.push_back(can::encode(kNodes[j], can::Tpdo1{word, 100, 0, 0}));
    }
    link.drain();
    for (std::size_t j = 0; j < 3; ++j) EXPECT_EQ(link.reading().torque_limited[j], j == limited);
  }
}

/// A drive that is stopped takes no RPDO, whoever sends it; and somebody who starts it again is answered.
TEST_F(HandLinkTest, StoppingTakesTheDrivesOffTheNetworkInEveryPeriod) {
  period();
  const auto stops = [this] { return std::ranges::count(bus.sent, can::encode_nmt(can::NmtCommand::kStop)); };
  link.write({{}, rt::DriveRequest::kHold});
  EXPECT_EQ(stops(), 0);
  for (int i = 1; i <= 5; ++i) {
    link.send_sync();
    link.write({{}, rt::DriveRequest::kStop});
    EXPECT_EQ(stops(), i);
    EXPECT_EQ(last_rpdo(1).controlword, can::cia402::kControlDisableVoltage);
  }
}

/// The drives' map says SYNC without a counter: one with a counter is another frame, and costs bits.
TEST_F(HandLinkTest, SyncCarriesNothing) {
  link.send_sync();
  EXPECT_EQ(bus.sent.front(), (can::Frame{0x080, 0, {}}));
}

/// Each bit of the buttons' word by itself.
TEST_F(HandLinkTest, ReadsEachButtonAndHowLongATorqueWasHeld) {
  const auto told = [this](std::uint16_t buttons) {
    link.send_sync();
    answer_all(State::kOperationEnabled, 100, buttons);
    link.drain();
    return link.reading();
  };
  for (unsigned bits = 0; bits < 8; ++bits) {
    const auto r = told(static_cast<std::uint16_t>(bits));
    EXPECT_EQ(r.grip, (bits & can::profile::kButtonGrip) != 0) << bits;
    EXPECT_EQ(r.dead_man, (bits & can::profile::kButtonDeadMan) != 0) << bits;
    EXPECT_EQ(r.clutch, (bits & can::profile::kButtonClutch) != 0) << bits;
    EXPECT_EQ(r.torque_held[2], 0);
  }
  for (int held = 0; held < 32; ++held)
    EXPECT_EQ(told(can::profile::with_held(can::profile::kButtonGrip, held)).torque_held[2], held);
}

TEST_F(HandLinkTest, TorqueIsTakenAsItIsToldAndNotBeforeItIs) {
  for (const double t : link.reading().torque_Nm) EXPECT_TRUE(std::isnan(t));
  link.send_sync();
  const std::int16_t told[] = {-1000, 250, 0};
  for (std::size_t j = 0; j < 3; ++j)
    bus.inbox.push_back(
        can::encode(kNodes[j], can::Tpdo1{can::cia402::statusword_of(State::kOperationEnabled), 0, told[j], 0}));
  link.drain();
  EXPECT_DOUBLE_EQ(link.reading().torque_Nm[0], -0.3);
  EXPECT_DOUBLE_EQ(link.reading().torque_Nm[1], 0.075);
  EXPECT_TRUE(std::isnan(link.reading().torque_Nm[2])) << "its message has buttons there";
}

TEST_F(HandLinkTest, ANodeThatIsNotOperationalIsTroubleUntilItIs) {
  for (const auto state : {can::NmtState::kStopped, can::NmtState::kPreOperational, can::NmtState::kBootUp}) {
    bus.inbox.push_back(can::encode(can::Heartbeat{kNodes[2], state}));
    EXPECT_TRUE(period().drive_fault) << static_cast<int>(state);
    bus.inbox.push_back(can::encode(can::Heartbeat{kNodes[2], can::NmtState::kOperational}));
    EXPECT_FALSE(period().drive_fault);
  }
}

TEST_F(HandLinkTest, ADriveOnItsWayIntoAFaultIsInOne) {
  link.send_sync();
  answer(0);
  answer(1, State::kFaultReactionActive);
  answer(2);
  link.drain();
  EXPECT_TRUE(link.reading().drive_fault);
}

/// What it complained of is over when somebody asked it back up and it came: not while it is merely operated.
TEST_F(HandLinkTest, AnEmergencyIsForgottenByEnablingOnly) {
  period();
  bus.inbox.push_back(can::encode(can::Emergency{kNodes[1], can::emcy::kRpdoTimeout, can::emcy::kGenericBit}));
  for (const auto request : {rt::DriveRequest::kOperate, rt::DriveRequest::kHold, rt::DriveRequest::kStop}) {
    EXPECT_TRUE(period().drive_fault);
    link.write({{}, request});
  }
  EXPECT_TRUE(period().drive_fault);
  link.write({{}, rt::DriveRequest::kEnable});
  EXPECT_FALSE(period().drive_fault);
}

/// A reset is an edge: zero in between, or a drive that faults again is never reset again.
TEST(HandLinkControlword, AFaultResetAlternatesWithZero) {
  std::uint16_t word = 0;
  for (int i = 0; i < 6; ++i) {
    word = controlword(rt::DriveRequest::kEnable, can::cia402::State::kFault, word);
    EXPECT_EQ(word, i % 2 == 0 ? can::cia402::kControlFaultReset : can::cia402::kControlDisableVoltage) << i;
  }
}

TEST_F(HandLinkTest, EveryFaultIsResetByAnEdgeOfItsOwn) {
  std::vector<std::uint16_t> words;
  for (int i = 0; i < 4; ++i) {
    link.send_sync();
    answer_all(State::kFault);
    link.drain();
    link.write({{}, rt::DriveRequest::kEnable});
    words.push_back(last_rpdo(1).controlword);
  }
  EXPECT_EQ(words, (std::vector<std::uint16_t>{0x80, 0, 0x80, 0}));
}

/// More than a bus can carry in a period, in one go: a stalled hand's messages pile up and must not stay behind.
TEST_F(HandLinkTest, TakesAWholeBusyPeriodAtOnce) {
  link.send_sync();
  for (int i = 0; i < 20; ++i) answer_all(State::kOperationEnabled, i);
  link.drain();
  EXPECT_DOUBLE_EQ(link.reading().q_rad[0], can::angle_rad(19));
}

TEST_F(HandLinkTest, ALostBusIsSeenAtOnce) {
  period();
  bus.lost = true;
  link.send_sync();
  EXPECT_TRUE(link.is_settled());  // nothing to wait for
  EXPECT_TRUE(link.reading().bus_lost);
  EXPECT_EQ(link.write({{0.1, 0.1, 0.1}, rt::DriveRequest::kOperate}), (std::array<std::int16_t, 3>{}));
}

/// A controller that restarts at once, an interface that comes back: the loss is a fault all the same.
TEST_F(HandLinkTest, ALossThatIsOverBeforeTheNextReadingIsTold) {
  const auto lost_for = [this](const auto& step) {
    bus.lost = true;
    step();
    bus.lost = false;
    link.send_sync();
    answer_all();
    link.drain();
    const bool told = link.reading().bus_lost;
    link.write({{}, rt::DriveRequest::kOperate});
    EXPECT_FALSE(period().bus_lost) << "told once";
    link.write({{}, rt::DriveRequest::kOperate});
    return told;
  };
  EXPECT_FALSE(lost_for([] {})) << "nobody can have seen it";
  EXPECT_TRUE(lost_for([this] { link.drain(); }));
  EXPECT_TRUE(lost_for([this] { link.send_sync(); }));
  EXPECT_TRUE(lost_for([this] { link.write({{}, rt::DriveRequest::kOperate}); }));
}

TEST_F(HandLinkTest, WritesPerMilleAndSaysWhatItSent) {
  period();
  const auto sent = link.write({{0.03, -0.3, 9.0}, rt::DriveRequest::kOperate});
  EXPECT_EQ(sent, (std::array<std::int16_t, 3>{100, -1000, 3000}));
  EXPECT_EQ(last_rpdo(1).target_torque_permille, -1000);
  EXPECT_EQ(last_rpdo(1).controlword, can::cia402::kControlEnableOperation);
}

TEST_F(HandLinkTest, BringsADriveUpAndDown) {  // the drive is protocol's own state machine, two periods of delay
  State drive = State::kFault;
  std::uint16_t before = 0;
  const auto run = [&](rt::DriveRequest request, int periods) {
    for (int i = 0; i < periods; ++i) {
      link.send_sync();
      answer_all(drive);
      link.drain();
      const std::uint16_t word = last_rpdo(0).controlword;
      if (const auto event = can::cia402::event_of(before, word)) drive = can::cia402::next(drive, *event);
      before = word;
      link.write({{}, request});
    }
  };
  run(rt::DriveRequest::kOperate, 10);
  EXPECT_EQ(drive, State::kFault);  // operating resets nothing
  run(rt::DriveRequest::kEnable, 15);
  EXPECT_EQ(drive, State::kOperationEnabled);
  run(rt::DriveRequest::kHold, 3);
  EXPECT_FALSE(can::cia402::may_produce_torque(drive));
}

TEST(RigBus, ReturnsAsSoonAsBothHandsAnswered) {
  FakeBus left, right;
  FakeWait wait;
  RigBus rig(left, right, wait);
  rig.send_sync();
  wait.on_wait = [&] {
    for (FakeBus* bus : {&left, &right}) {
      if (wait.time == Nanoseconds(bus == &left ? 200'000 : 400'000)) {
        for (const auto node : kNodes) bus->inbox.push_back(can::encode(node, can::Tpdo1{0x27, 0, 0, 0}));
      }
    }
  };
  const auto reading = rig.read_tpdos(std::chrono::microseconds(600));
  EXPECT_EQ(wait.time, std::chrono::microseconds(400));
  EXPECT_EQ(reading.hand[0].age_ticks, 0);
  EXPECT_EQ(reading.hand[1].age_ticks, 0);
}

TEST(RigBus, EachHandHasItsOwnBus) {
  FakeBus left, right;
  FakeWait wait;
  RigBus rig(left, right, wait);
  rig.send_sync();
  for (const auto node : kNodes) left.inbox.push_back(can::encode(node, can::Tpdo1{0x27, 10, 0, 0}));
  for (const auto node : kNodes) right.inbox.push_back(can::encode(node, can::Tpdo1{0x27, 20, 0, 0}));
  const auto reading = rig.read_tpdos(std::chrono::microseconds(600));
  EXPECT_DOUBLE_EQ(reading.hand[0].q_rad[0], can::angle_rad(10));
  EXPECT_DOUBLE_EQ(reading.hand[1].q_rad[0], can::angle_rad(20));
  rt::RigCommand command;
  command.hand[0] = {{0.03, 0.0, 0.0}, rt::DriveRequest::kOperate};
  command.hand[1] = {{-0.06, 0.0, 0.0}, rt::DriveRequest::kHold};
  const auto sent = rig.write_rpdos(command);
  EXPECT_EQ(sent[0][0], 100);
  EXPECT_EQ(sent[1][0], -200);
  const auto first_rpdo = [](const FakeBus& bus) {
    for (const auto& f : bus.sent)
      if (const auto rpdo = can::decode_rpdo1(kNodes[0], f)) return *rpdo;
    return can::Rpdo1{};
  };
  EXPECT_EQ(first_rpdo(left), (can::Rpdo1{can::cia402::kControlEnableOperation, 100}));
  EXPECT_EQ(first_rpdo(right), (can::Rpdo1{can::cia402::kControlDisableVoltage, -200}));
}

/// It holds up no answer to SYNC, and never is one for both hands in one period.
TEST(RigBus, TheMastersHeartbeatGoesBeforeTheTorquesOfEveryFiftiethPeriod) {
  FakeBus left, right;
  FakeWait wait;
  RigBus rig(left, right, wait);
  std::vector<int> beats[2];
  for (int period = 0; period < 200; ++period) {
    for (FakeBus* bus : {&left, &right}) bus->sent.clear();
    rig.send_sync();
    EXPECT_EQ(left.sent.size() + right.sent.size(), 2U) << "two SYNCs and nothing else";
    (void)rig.write_rpdos({});
    for (FakeBus* bus : {&left, &right}) {
      if (bus->sent.size() == 4) continue;
      ASSERT_EQ(bus->sent.size(), 5U);
      EXPECT_EQ(bus->sent[1], can::encode(can::Heartbeat{can::kMasterNode, can::NmtState::kOperational}));
      beats[bus == &right].push_back(period);
    }
  }
  EXPECT_EQ(beats[0], (std::vector{0, 50, 100, 150}));
  EXPECT_EQ(beats[1], (std::vector{25, 75, 125, 175}));
}

TEST_F(HandLinkTest, NoHeartbeatGoesOutOnceSomebodyElseCommandsTheDrives) {
  (void)link.write({});
  bus.inbox.push_back(can::encode(can::kWaist, can::Rpdo1{can::cia402::kControlEnableOperation, 3000}));
  bus.sent.clear();
  for (int i = 0; i < 200; ++i) {
    period();
    (void)link.write({});
  }
  for (const auto& f : bus.sent) EXPECT_NE(f.id, 0x77FU);
}

TEST(RigBus, DoesNotWaitBeyondTheDeadline) {
  FakeBus left, right;
  FakeWait wait;
  RigBus rig(left, right, wait);
  rig.send_sync();
  EXPECT_FALSE(rig.read_tpdos(std::chrono::microseconds(600)).hand[0].valid);
  EXPECT_EQ(wait.time, std::chrono::microseconds(600));
}

}  // namespace
}  // namespace ligature::platform
