// Start-up by SDO with drives that answer, reject, are of another kind, or stay silent.
#include "firmware/platform/can_master.hpp"

#include <gtest/gtest.h>

#include <map>

#include "firmware/platform/cia402_facts.hpp"
#include "protocol/can/codec.hpp"
#include "protocol/can/heartbeat.hpp"
#include "protocol/can/nmt.hpp"
#include "tests/unit/platform/fake_bus.hpp"

namespace ligature::platform {
namespace {

class CanMasterTest : public ::testing::Test {
 protected:
  void SetUp() override {
    values[can::od::kRatedTorque] = can::profile::kRatedTorque_mNm;
    values[can::od::kEncoderIncrements] = static_cast<std::uint32_t>(can::profile::kCountsPerRevolution);
    values[can::od::kModeOfOperationDisplay] = can::profile::kCyclicSynchronousTorque;
    bus.on_send = [this](const can::Frame& f) { answer(f); };
  }
  void answer(const can::Frame& f) {
    const auto request = can::decode_sdo(f);
    if (!request || request->node == silent) return;
    can::Sdo reply{can::SdoKind::kWritten, request->node, request->object, 0, 0};
    if (request->object == refused) {
      reply = {can::SdoKind::kAbort, request->node, request->object, can::sdo_abort::kReadOnly, 0};
    } else if (request->kind == can::SdoKind::kRead) {
      reply = {can::SdoKind::kValue, request->node, request->object, values[request->object], 4};
    } else {
      ++writes[request->node.value];
      written[request->object] = request->value;
    }
    // First an answer from another node, which must be ignored.
    bus.inbox.push_back(can::encode(can::Sdo{can::SdoKind::kWritten, can::NodeId{99}, request->object, 0, 0}));
    // Then a late answer of the same node about another object, which must be ignored, too.
    bus.inbox.push_back(can::encode(can::Sdo{can::SdoKind::kValue, request->node, can::od::kErrorCode, 7, 4}));
    bus.inbox.push_back(can::encode(reply));
  }
  std::optional<std::string> configure() { return configure_drives(bus, wait, {50, 300, 100}); }

  FakeBus bus;
  FakeWait wait;
  std::map<can::Object, std::uint32_t> values, written;
  std::map<int, int> writes;
  can::NodeId silent{0};
  can::Object refused{};
};

TEST_F(CanMasterTest, WritesTheWholePlanToEveryDrive) {
  EXPECT_EQ(configure(), std::nullopt);
  for (const auto node : can::profile::kJointNodes) {
    EXPECT_EQ(writes[node.value], static_cast<int>(can::startup_plan(node).count));
  }
  EXPECT_EQ(written[can::od::kModeOfOperation], 10U);
  EXPECT_EQ(written[can::od::kRpdo1EventTimer], 50U);
  EXPECT_EQ(bus.sent.front(), can::encode_nmt(can::NmtCommand::kEnterPreOperational));
  for (const auto& f : bus.sent) EXPECT_NE(f, can::encode_nmt(can::NmtCommand::kStart));
}

TEST_F(CanMasterTest, ASilentDriveIsNamed) {
  silent = can::kShoulder;
  EXPECT_EQ(configure(), "node 2, object 0x6076:00: no answer; remedy: check its power, node id, bit rate and cable");
  EXPECT_GE(wait.time, std::chrono::milliseconds(500));
}

TEST_F(CanMasterTest, ARefusalIsNamedWithItsCode) {
  refused = can::od::kMaxTorque;
  EXPECT_EQ(configure(), "node 1, object 0x6072:00: refused by the drive, abort code 0x06010002");
}

TEST_F(CanMasterTest, ARefusalToBeReadIsNamedWithItsCode) {
  refused = can::od::kRatedTorque;
  EXPECT_EQ(configure(), "node 1, object 0x6076:00: refused by the drive, abort code 0x06010002");
}

/// Each object that depends on the device file is written with the file's value.
TEST_F(CanMasterTest, WritesWhatTheDevicesRecordSays) {
  device::Device d = device::omni();
  d.max_torque_permille = 1234;
  d.rated_torque_Nm = 0.05;
  d.motor_counts = 1000, d.gear = 2.0;
  values[can::od::kRatedTorque] = 50;
  values[can::od::kEncoderIncrements] = 2000;
  EXPECT_EQ(configure_drives(bus, wait, {50, 300, 100, drive_facts(d)}), std::nullopt);
  EXPECT_EQ(written[can::od::kMaxTorque], 1234U);
  EXPECT_EQ(written[can::od::kAbortConnectionOption], 1U) << "a lost link is a fault";
  EXPECT_EQ(written[can::od::kProducerHeartbeat], 100U);
  EXPECT_EQ(written[can::od::kConsumerHeartbeat], can::consumer_heartbeat_value(can::kMasterNode, 300));
}

/// A drive in another mode would take the number of a torque for a speed.
TEST_F(CanMasterTest, ADriveThatStaysInAnotherModeIsRefused) {
  values[can::od::kModeOfOperationDisplay] = 9;
  EXPECT_EQ(configure(), "node 1, object 0x6061:00: found 9, allowed 10");
}

TEST_F(CanMasterTest, ADriveMayNeedAMomentToChangeItsMode) {
  values[can::od::kModeOfOperationDisplay] = 0;
  wait.on_wait = [this] {
    if (wait.time >= std::chrono::milliseconds(100)) values[can::od::kModeOfOperationDisplay] = 10;
  };
  EXPECT_EQ(configure(), std::nullopt);
}

TEST_F(CanMasterTest, StartingIsOneNmtCommandToAll) {
  EXPECT_TRUE(start_drives(bus));
  EXPECT_EQ(bus.sent, std::vector<can::Frame>{can::encode_nmt(can::NmtCommand::kStart)});
}

// Torques are per mille of the rated torque, so forces would be wrong.
TEST_F(CanMasterTest, ADriveOfAnotherSizeIsRefused) {
  values[can::od::kRatedTorque] = 1000;
  EXPECT_EQ(configure(), "node 1, object 0x6076:00: found 1000, allowed 300");
}

TEST_F(CanMasterTest, AnEncoderOfAnotherResolutionIsRefused) {  // all angles would be wrong
  values[can::od::kEncoderIncrements] = 4096;
  EXPECT_EQ(configure(),
            "node 1, object 0x608F:01: found 4096, allowed " + std::to_string(can::profile::kCountsPerRevolution));
}

/// Two controllers that start at the same time both find the bus free. Each must then detect the other's first frames.
TEST_F(CanMasterTest, AControllerThatStartsInTheSameMomentIsHeardWhileDrivesAreSetUp) {
  const can::Frame of_a_master[] = {can::encode_nmt(can::NmtCommand::kEnterPreOperational),
                                    can::sdo_read(can::kWaist, can::od::kRatedTorque),
                                    can::sdo_write(can::kElbow, can::od::kMaxTorque, 1, 2), can::sync_frame()};
  for (const auto& frame : of_a_master) {
    for (const std::size_t after : {std::size_t{1}, std::size_t{2}, std::size_t{30}}) {
      bus.sent.clear();
      bus.inbox.clear();
      bus.on_send = [&](const can::Frame& f) {
        if (bus.sent.size() == after) bus.inbox.push_back(frame);
        answer(f);
      };
      const auto why = configure();
      ASSERT_TRUE(why.has_value()) << frame.id;
      EXPECT_NE(why->find("another controller is on this bus"), std::string::npos) << *why;
      EXPECT_NE(why->find("remedy: "), std::string::npos);
      EXPECT_LE(bus.sent.size(), after + 1) << "not a word more";
    }
  }
}

TEST_F(CanMasterTest, HearsAnotherControllerBeforeItSpeaks) {
  const can::Frame of_a_master[] = {can::sync_frame(),
                                    can::encode(can::Heartbeat{can::kMasterNode, can::NmtState::kOperational}),
                                    can::encode(can::kElbow, can::Rpdo1{}), can::encode_nmt(can::NmtCommand::kStart),
                                    can::sdo_read(can::kElbow, can::od::kStatusword)};
  for (const auto& frame : of_a_master) {
    wait.on_wait = [&] {
      if (wait.time == std::chrono::milliseconds(5)) bus.inbox.push_back(frame);
    };
    wait.time = Nanoseconds(0);
    EXPECT_TRUE(other_master(bus, wait).has_value()) << frame.id;
  }
  EXPECT_TRUE(bus.sent.empty());
}

TEST_F(CanMasterTest, DrivesAloneAreNoOtherController) {
  wait.on_wait = [&] {
    bus.inbox.push_back(can::encode(can::Heartbeat{can::kElbow, can::NmtState::kOperational}));
    bus.inbox.push_back(can::encode(can::kElbow, can::Tpdo1{}));
  };
  EXPECT_EQ(other_master(bus, wait), std::nullopt);
  EXPECT_GE(wait.time, std::chrono::milliseconds(60));  // longer than the interval between two heartbeats
}

TEST_F(CanMasterTest, LeavesTheDrivesPreOperationalAndUnwatched) {
  release_drives(bus, wait);
  EXPECT_EQ(bus.sent.front(), can::encode_nmt(can::NmtCommand::kEnterPreOperational));
  for (const auto node : can::profile::kJointNodes) EXPECT_EQ(writes[node.value], 1);
  EXPECT_EQ(written[can::od::kConsumerHeartbeat], 0U);
}

/// A drive that ignores NMT and stays on: its watchdog must not be switched off, because only the watchdog ends the
/// torque.
TEST_F(CanMasterTest, ADriveThatIsStillOnKeepsItsWatchdog) {
  for (const std::uint32_t statusword : {0x0237U, 0x0217U, 0x021FU}) {  // enabled, quick stop, reaction to a fault
    writes.clear();
    values[can::od::kStatusword] = statusword;
    release_drives(bus, wait);
    for (const auto node : can::profile::kJointNodes) EXPECT_EQ(writes[node.value], 0) << statusword;
  }
  refused = can::od::kStatusword;
  release_drives(bus, wait);
  EXPECT_EQ(writes[1], 0) << "it does not say";
}

TEST_F(CanMasterTest, ALostBusEndsAtOnce) {
  bus.on_send = [this](const can::Frame&) { bus.lost = true; };
  EXPECT_TRUE(configure().has_value());
  EXPECT_LT(wait.time, std::chrono::milliseconds(1));
}

}  // namespace
}  // namespace ligature::platform
