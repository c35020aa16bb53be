#include "sim_device/drive_node.hpp"

#include <gtest/gtest.h>

#include <optional>

#include "protocol/can/startup.hpp"

namespace ligature::sim {
namespace {

using can::cia402::State;
using std::chrono::milliseconds;

/// One drive whose bus frames and encoder the test controls.
struct Bench {
  Bench() {
    drive.power_on(now, out);
    for (const can::SdoWrite& w : can::startup_plan(
             can::kWaist, {.rpdo_timeout_ms = 20, .heartbeat_timeout_ms = 300, .heartbeat_period_ms = 100})) {
      give(can::sdo_write(can::kWaist, w.object, w.value, w.bytes));
    }
    give(can::encode_nmt(can::NmtCommand::kStart));
    out.clear();
  }
  void give(const can::Frame& f) { drive.on_frame(f, now, sensed, out); }
  void rpdo(std::uint16_t controlword, std::int16_t torque = 0) {
    give(can::encode(can::kWaist, can::Rpdo1{controlword, torque}));
  }
  void sync() { give(can::sync_frame()); }
  void command(std::uint16_t controlword, std::int16_t torque = 0) {
    rpdo(controlword, torque);
    sync();
  }
  void enable() {
    command(can::cia402::kControlShutdown);
    command(can::cia402::kControlSwitchOn);
    command(can::cia402::kControlEnableOperation);
    out.clear();
  }
  void pass(Time span) {
    now += span;
    drive.poll(now, {}, out);
  }
  [[nodiscard]] std::vector<std::uint16_t> emergencies() const {
    std::vector<std::uint16_t> codes;
    for (const can::Frame& f : out) {
      if (const auto e = can::decode_emergency(f)) codes.push_back(e->code);
    }
    return codes;
  }

  Time now = milliseconds(1000);
  Sensed sensed{1234, 0};
  std::vector<can::Frame> out;
  DriveNode drive{can::kWaist};
};

TEST(DriveNode, SaysBootUpAndWaitsPreOperational) {
  DriveNode drive(can::kShoulder);
  std::vector<can::Frame> out;
  drive.power_on(Time(0), out);
  EXPECT_EQ(out, std::vector{can::encode(can::Heartbeat{can::kShoulder, can::NmtState::kBootUp})});
  EXPECT_EQ(drive.nmt_state(), can::NmtState::kPreOperational);
  EXPECT_EQ(drive.state(), State::kSwitchOnDisabled);
  out.clear();
  drive.on_frame(can::sync_frame(), Time(0), {}, out);
  EXPECT_TRUE(out.empty()) << "no process data before NMT start";
}

TEST(DriveNode, TorqueSentInOneTickActsAtTheNextSync) {
  Bench b;
  b.enable();
  b.rpdo(can::cia402::kControlEnableOperation, 777);
  EXPECT_EQ(b.drive.torque_permille(), 0);  // received, but acts only from the next SYNC
  b.sync();
  EXPECT_EQ(b.drive.torque_permille(), 777);
  const auto at_first = can::decode_tpdo1(can::kWaist, b.out.back());
  EXPECT_EQ(at_first->torque_permille, 0);  // SYNC latches the inputs before the RPDO acts
  b.rpdo(can::cia402::kControlEnableOperation, -5);
  b.sync();
  EXPECT_EQ(can::decode_tpdo1(can::kWaist, b.out.back())->torque_permille, 777);
  EXPECT_EQ(can::decode_tpdo1(can::kWaist, b.out.back())->position_counts, 1234);
}

TEST(DriveNode, TheLastRpdoBeforeASyncActs) {
  Bench b;
  b.enable();
  b.rpdo(can::cia402::kControlEnableOperation, 100);
  b.rpdo(can::cia402::kControlEnableOperation, 200);
  b.sync();
  EXPECT_EQ(b.drive.torque_permille(), 200);
  EXPECT_EQ(b.drive.stats().late_rpdos, 1);
}

TEST(DriveNode, TorqueIsClippedAtTheMaximumAndSaysSo) {
  Bench b;
  b.enable();
  b.command(can::cia402::kControlEnableOperation, 3100);
  EXPECT_EQ(b.drive.torque_permille(), 3000);
  b.sync();
  EXPECT_NE(can::decode_tpdo1(can::kWaist, b.out.back())->statusword & can::cia402::kInternalLimitBit, 0);
}

TEST(DriveNode, MakesTorqueOnlyInOperationEnabled) {
  Bench b;
  for (const std::uint16_t word :
       {can::cia402::kControlDisableVoltage, can::cia402::kControlShutdown, can::cia402::kControlSwitchOn}) {
    b.command(word, 500);
    EXPECT_EQ(b.drive.torque_permille(), 0);
  }
  b.enable();
  b.command(can::cia402::kControlEnableOperation, 500);
  EXPECT_EQ(b.drive.torque_permille(), 500);
  b.command(can::cia402::kControlQuickStop, 500);
  EXPECT_EQ(b.drive.torque_permille(), 0);
  EXPECT_EQ(b.drive.state(), State::kSwitchOnDisabled);
}

TEST(DriveNode, WithoutAModeItIsNotEnabled) {
  Bench b;
  b.give(can::sdo_write(can::kWaist, can::od::kModeOfOperation, 0, 1));
  b.enable();
  EXPECT_EQ(b.drive.state(), State::kSwitchedOn);
}

TEST(DriveNode, SilenceOfRpdosTakesTorqueAwayAtTheSetTime) {
  Bench b;
  b.enable();
  b.command(can::cia402::kControlEnableOperation, 900);
  EXPECT_EQ(b.drive.next_deadline(), b.now + milliseconds(20));
  b.pass(milliseconds(20) - Time(1));
  EXPECT_EQ(b.drive.torque_permille(), 900);
  b.pass(Time(1));
  EXPECT_EQ(b.drive.torque_permille(), 0);
  EXPECT_EQ(b.drive.state(), State::kFault);
  EXPECT_EQ(b.emergencies(), std::vector{can::emcy::kRpdoTimeout});
  EXPECT_EQ(b.drive.stats().watchdog_trips, 1);
}

TEST(DriveNode, SilenceOfTheMasterTakesTorqueAway) {
  Bench b;
  b.enable();
  b.give(can::encode(can::Heartbeat{can::kMasterNode, can::NmtState::kOperational}));
  for (int i = 0; i < 300; ++i) {  // RPDOs continue, the heartbeat stops
    EXPECT_EQ(b.drive.state(), State::kOperationEnabled);
    b.command(can::cia402::kControlEnableOperation, 900);
    b.pass(milliseconds(1));
  }
  EXPECT_EQ(b.drive.torque_permille(), 0);
  EXPECT_EQ(b.emergencies(), std::vector{can::emcy::kHeartbeatLost});
}

TEST(DriveNode, AFaultIsLeftOnlyByFaultReset) {
  Bench b;
  b.enable();
  b.command(can::cia402::kControlEnableOperation, 900);
  b.pass(milliseconds(25));
  for (const std::uint16_t word :
       {can::cia402::kControlEnableOperation, can::cia402::kControlShutdown, can::cia402::kControlDisableVoltage}) {
    b.command(word, 900);
    EXPECT_EQ(b.drive.state(), State::kFault);
    EXPECT_EQ(b.drive.torque_permille(), 0);
  }
  b.give(can::encode_nmt(can::NmtCommand::kResetCommunication));
  EXPECT_EQ(b.drive.state(), State::kFault);
  b.give(can::encode_nmt(can::NmtCommand::kStart));
  b.out.clear();
  b.command(can::cia402::kControlFaultReset);
  EXPECT_EQ(b.drive.state(), State::kSwitchOnDisabled);
  EXPECT_EQ(b.emergencies(), std::vector{can::emcy::kNoError});
}

TEST(DriveNode, LeavingOperationalDisablesWithoutAFault) {
  for (const can::NmtCommand c : {can::NmtCommand::kStop, can::NmtCommand::kEnterPreOperational,
                                  can::NmtCommand::kResetCommunication, can::NmtCommand::kResetNode}) {
    Bench b;
    b.enable();
    b.command(can::cia402::kControlEnableOperation, 900);
    b.give(can::encode_nmt(c, can::kWaist));
    EXPECT_EQ(b.drive.torque_permille(), 0);
    EXPECT_EQ(b.drive.state(), State::kSwitchOnDisabled);
    b.pass(milliseconds(100));
    EXPECT_EQ(b.drive.stats().watchdog_trips, 0) << "nobody needs to command a drive that is not operational";
  }
}

TEST(DriveNode, AResetOfCommunicationForgetsTheBusAndNotTheMode) {
  const auto told = [](Bench& b, can::Object object) -> std::optional<std::uint32_t> {
    b.out.clear();
    b.give(can::sdo_read(can::kWaist, object));
    const auto answer = b.out.empty() ? std::nullopt : can::decode_sdo(b.out.front());
    return answer && answer->kind == can::SdoKind::kValue ? std::optional(answer->value) : std::nullopt;
  };
  for (const auto command : {can::NmtCommand::kResetCommunication, can::NmtCommand::kResetNode}) {
    Bench b;
    b.give(can::encode_nmt(command, can::kWaist));
    EXPECT_EQ(told(b, can::od::kProducerHeartbeat), 0U);
    EXPECT_EQ(told(b, can::od::kModeOfOperation), command == can::NmtCommand::kResetCommunication ? 10U : 0U);
    b.out.clear();
    b.pass(milliseconds(1000));
    EXPECT_TRUE(b.out.empty()) << "its heart beats, but nobody asked for that since";
  }
}

TEST(DriveNode, BeatsItsHeart) {
  Bench b;
  for (int i = 0; i < 5; ++i) b.pass(milliseconds(100));
  int beats = 0;
  for (const can::Frame& f : b.out)
    beats += f == can::encode(can::Heartbeat{can::kWaist, can::NmtState::kOperational}) ? 1 : 0;
  EXPECT_EQ(beats, 5);
}

TEST(DriveNode, ASilentHeartbeatBeforeTheFirstOneIsNoFault) {
  Bench b;
  b.pass(milliseconds(5000));
  EXPECT_EQ(b.drive.state(), State::kSwitchOnDisabled);
  EXPECT_TRUE(b.emergencies().empty());
}

}  // namespace
}  // namespace ligature::sim
