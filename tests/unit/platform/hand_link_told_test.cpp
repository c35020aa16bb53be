// What drives report besides their joints, and frames of other senders on the bus.
#include <algorithm>
#include <utility>

#include "protocol/can/emcy.hpp"
#include "protocol/can/heartbeat.hpp"
#include "protocol/can/nmt.hpp"
#include "protocol/can/sdo.hpp"
#include "protocol/can/units.hpp"
#include "tests/unit/platform/hand_link_fixture.hpp"

namespace ligature::platform {
namespace {

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
      {{0x301, 8, {}}, Foreign::kTorque},  // RPDO 2 and 4, which a drive may have enabled by default
      {{0x503, 8, {}}, Foreign::kTorque},
      {can::sync_frame(), Foreign::kBeat},
      {{0x080, 1, {7}}, Foreign::kBeat},  // with a SYNC counter
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
  constexpr std::array<bool, 3> kNoJoint{};
  EXPECT_EQ(period().torque_astray, kNoJoint);
  for (std::size_t astray = 0; astray < 3; ++astray) {
    link.send_sync();
    for (std::size_t j = 0; j < 3; ++j) {
      const std::uint16_t bit = j == astray ? can::cia402::kTorqueAstrayBit : std::uint16_t{0};
      const auto word = static_cast<std::uint16_t>(can::cia402::statusword_of(State::kOperationEnabled) | bit);
      bus.inbox.push_back(can::encode(kNodes[j], can::Tpdo1{word, 100, 0, 0}));
    }
    link.drain();
    for (std::size_t j = 0; j < 3; ++j) EXPECT_EQ(link.reading().torque_astray[j], j == astray) << astray;
  }
  EXPECT_EQ(period().torque_astray, kNoJoint);
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

TEST_F(HandLinkTest, TheDriveInTroubleIsNamed) {
  EXPECT_EQ(period().bad_joint, -1);
  for (std::size_t bad = 0; bad < 3; ++bad) {
    link.send_sync();
    for (std::size_t j = 0; j < 3; ++j) answer(j, j == bad ? State::kSwitchedOn : State::kOperationEnabled);
    link.drain();
    EXPECT_EQ(link.reading().bad_joint, static_cast<int>(bad)) << "not enabled";
    EXPECT_EQ(link.reading().drive_error, 0U);
    EXPECT_EQ(period().bad_joint, -1);
    link.send_sync();
    for (std::size_t j = 0; j < 3; ++j) {
      if (j != bad) answer(j);
    }
    link.drain();
    EXPECT_EQ(link.reading().bad_joint, static_cast<int>(bad)) << "no answer";
    bus.inbox.push_back(can::encode(can::Heartbeat{kNodes[bad], can::NmtState::kStopped}));
    EXPECT_EQ(period().bad_joint, static_cast<int>(bad)) << "not operational";
    bus.inbox.push_back(can::encode(can::Heartbeat{kNodes[bad], can::NmtState::kOperational}));
    EXPECT_EQ(period().bad_joint, -1);
  }
  bus.inbox.push_back(can::encode(can::Emergency{kNodes[1], can::emcy::kRpdoTimeout, can::emcy::kGenericBit}));
  link.send_sync();
  answer(1), answer(2);
  link.drain();
  EXPECT_EQ(link.reading().bad_joint, 1) << "a failed drive counts more than a silent one";
  EXPECT_EQ(period().bad_joint, 1);
  EXPECT_EQ(period().drive_error, std::uint32_t{can::emcy::kRpdoTimeout});
}

/// While the drives start up none is enabled, and the one that does not answer is the one to look for.
TEST_F(HandLinkTest, BeforeTheFirstSampleTheSilentDriveIsNamed) {
  for (std::size_t silent = 0; silent < 3; ++silent) {
    for (int k = 0; k < 5; ++k) {
      link.send_sync();
      for (std::size_t j = 0; j < 3; ++j) {
        if (j != silent) answer(j, State::kSwitchOnDisabled);
      }
      link.drain();
      EXPECT_EQ(link.reading().bad_joint, static_cast<int>(silent)) << k;
    }
  }
}

/// An emergency is cleared only by the request kEnable to a drive that is enabled, not by other requests.
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

/// Some drives have no other watchdog than the heartbeat. If such a drive does not obey, it keeps its torque as long as
/// heartbeats come.
class Heartbeats : public HandLinkTest {
 protected:
  /// Number of the controller's heartbeats in 200 periods with this request, while the drives answer in this state with
  /// this torque. The count begins 20 periods after the request, so that drives have time to obey.
  std::ptrdiff_t beats(rt::DriveRequest request, State state, std::int16_t permille = 0, bool answers = true) {
    for (int i = -20; i < 200; ++i) {
      if (i == 0) bus.sent.clear();
      link.send_sync();
      for (std::size_t j = 0; answers && j < 3; ++j)
        bus.inbox.push_back(can::encode(kNodes[j], can::Tpdo1{can::cia402::statusword_of(state), 100, permille, 0}));
      link.drain();
      (void)link.write({{}, request});
    }
    return std::ranges::count(bus.sent, can::encode(can::Heartbeat{can::kMasterNode, can::NmtState::kOperational}));
  }
  static constexpr std::ptrdiff_t kAll = 200 / HandLink::kHeartbeatPeriods;
};

TEST_F(Heartbeats, EndWithAStop) {
  EXPECT_EQ(beats(rt::DriveRequest::kOperate, State::kOperationEnabled, 500), kAll);
  EXPECT_EQ(beats(rt::DriveRequest::kStop, State::kOperationEnabled, 500), 0);
  EXPECT_EQ(beats(rt::DriveRequest::kStop, State::kSwitchOnDisabled), 0) << "nobody knows who else commands the drive";
}

TEST_F(Heartbeats, EndWhenADriveStaysOnThatShouldBeOff) {
  EXPECT_EQ(beats(rt::DriveRequest::kHold, State::kSwitchOnDisabled), kAll);
  EXPECT_EQ(beats(rt::DriveRequest::kHold, State::kFault), kAll);
  EXPECT_EQ(beats(rt::DriveRequest::kHold, State::kOperationEnabled), 0);
  EXPECT_EQ(beats(rt::DriveRequest::kHold, State::kQuickStopActive), 0);
  EXPECT_EQ(beats(rt::DriveRequest::kHold, State::kSwitchOnDisabled, 500), 0) << "it says off, but makes torque";
  EXPECT_EQ(beats(rt::DriveRequest::kHold, State::kSwitchOnDisabled, 0, false), 0) << "it says nothing";
}

TEST_F(Heartbeats, BeginAgainWhenTheDrivesMayBeOn) {
  EXPECT_EQ(beats(rt::DriveRequest::kHold, State::kOperationEnabled), 0);
  EXPECT_EQ(beats(rt::DriveRequest::kEnable, State::kFault), kAll);
  EXPECT_EQ(beats(rt::DriveRequest::kOperate, State::kOperationEnabled, 500), kAll);
}

TEST_F(HandLinkTest, NoHeartbeatGoesOutOnceSomebodyElseCommandsTheDrives) {
  (void)link.write({{}, rt::DriveRequest::kOperate});
  bus.inbox.push_back(can::encode(can::kWaist, can::Rpdo1{can::cia402::kControlEnableOperation, 3000}));
  bus.sent.clear();
  for (int i = 0; i < 200; ++i) {
    period();
    (void)link.write({{}, rt::DriveRequest::kOperate});
  }
  for (const auto& f : bus.sent) EXPECT_NE(f.id, 0x77FU);
}

}  // namespace
}  // namespace ligature::platform
