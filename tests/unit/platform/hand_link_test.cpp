// Cyclic traffic of one hand, with frames made by the tests: sample sets, their age, drive states and errors.
#include "firmware/platform/hand_link.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "protocol/can/emcy.hpp"
#include "protocol/can/heartbeat.hpp"
#include "protocol/can/nmt.hpp"
#include "protocol/can/sdo.hpp"
#include "protocol/can/units.hpp"
#include "tests/unit/platform/hand_link_fixture.hpp"

namespace ligature::platform {
namespace {

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

TEST_F(HandLinkTest, BusLoadIsThatOfThePeriodBefore) {  // SYNC, 3 TPDOs and 3 RPDOs: 617 .. 745 of 1000 bits
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
  EXPECT_DOUBLE_EQ(link.reading().q_rad[0], std::acos(-1.0) / 2.0);  // 2000 counts are a quarter of a turn
  const auto sent = link.write({{0.025, -0.001, 9.0}, rt::DriveRequest::kOperate});
  EXPECT_EQ(sent, (std::array<std::int16_t, 3>{500, -20, 3000}));
}

TEST_F(HandLinkTest, TwoOfThreeAreNoPose) {  // without the third joint the previous set is held and its age counted
  period();
  link.send_sync();
  answer(0, State::kOperationEnabled, 999);
  answer(2, State::kOperationEnabled, 999);
  link.drain();
  EXPECT_FALSE(link.is_settled());
  EXPECT_EQ(link.reading().age_ticks, 1);
  EXPECT_DOUBLE_EQ(link.reading().q_rad[0], can::angle_rad(100));
}

// Joints of different SYNCs must not be combined to a pose.
TEST_F(HandLinkTest, AJointOfTheLastSyncMakesNoSetWithTwoOfThis) {
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

/// A drive that left Operation Enabled by itself is brought back only by the request kEnable.
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
  answer_all(State::kOperationEnabled, 200);  // samples after the deadline
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

/// A stopped drive ignores RPDOs from any sender; if another node restarts it, it is stopped again.
TEST_F(HandLinkTest, StoppingTakesTheDrivesOffTheNetworkInEveryPeriod) {
  period();
  const auto stops = [this] { return std::ranges::count(bus.sent, can::encode_nmt(can::NmtCommand::kStop)); };
  link.write({{}, rt::DriveRequest::kHold});
  EXPECT_EQ(stops(), 0);
  for (int i = 0; i < 5; ++i) {
    link.send_sync();
    link.write({{0.1, 0.1, 0.1}, rt::DriveRequest::kStop});
    EXPECT_EQ(stops(), i);
    EXPECT_EQ(last_rpdo(1), (can::Rpdo1{can::cia402::kControlDisableVoltage, 0}));
  }
}

/// A synchronous RPDO acts at the next SYNC, and only in a drive that is not stopped yet.
TEST_F(HandLinkTest, AStopDisablesTheDrivesBeforeItTakesThemOffTheNetwork) {
  period();
  link.write({{0.1, 0.1, 0.1}, rt::DriveRequest::kOperate});
  bus.sent.clear();
  link.write({{}, rt::DriveRequest::kStop});
  link.send_sync();
  ASSERT_EQ(bus.sent.size(), 5U);
  for (std::size_t j = 0; j < 3; ++j)
    EXPECT_EQ(bus.sent[j], can::encode(kNodes[j], can::Rpdo1{can::cia402::kControlDisableVoltage, 0}));
  EXPECT_EQ(bus.sent[3], can::sync_frame());
  EXPECT_EQ(bus.sent[4], can::encode_nmt(can::NmtCommand::kStop));
}

/// After our torque of zero, another sender's torque could come; a stopped drive accepts neither.
TEST_F(HandLinkTest, AStopIsImmediateWhereSomebodyElseCommands) {
  bus.inbox.push_back(can::encode(kNodes[0], can::Rpdo1{can::cia402::kControlEnableOperation, 3000}));
  period();
  bus.sent.clear();
  link.write({{}, rt::DriveRequest::kStop});
  EXPECT_EQ(bus.sent.front(), can::encode_nmt(can::NmtCommand::kStop));
}

/// The drives are configured for a SYNC without counter, so the frame carries no data.
TEST_F(HandLinkTest, SyncCarriesNothing) {
  link.send_sync();
  EXPECT_EQ(bus.sent.front(), (can::Frame{0x080, 0, {}}));
}

/// Tests each bit of the buttons word separately.
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

/// A fault reset needs a rising edge, so the controlword alternates with zero; otherwise only the first reset would
/// act.
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

/// More frames than a bus can carry in a period: after a stall of a hand, all its queued frames must be read at once.
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
  EXPECT_TRUE(link.is_settled());  // no answer is awaited
  EXPECT_TRUE(link.reading().bus_lost);
  EXPECT_EQ(link.write({{0.1, 0.1, 0.1}, rt::DriveRequest::kOperate}), (std::array<std::int16_t, 3>{}));
}

/// The peer reconnects or the interface recovers before the next reading: the loss must still be reported.
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

TEST_F(HandLinkTest, BringsADriveUpAndDown) {  // simulated drive: state machine of CiA 402, two periods of delay
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
  EXPECT_EQ(drive, State::kFault);  // kOperate does not reset faults
  run(rt::DriveRequest::kEnable, 15);
  EXPECT_EQ(drive, State::kOperationEnabled);
  run(rt::DriveRequest::kHold, 3);
  EXPECT_FALSE(can::cia402::may_produce_torque(drive));
}

}  // namespace
}  // namespace ligature::platform
