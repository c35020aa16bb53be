// The simulated CiA 402 drive of a device record: its objects and its process data.
#include <gtest/gtest.h>

#include <cmath>

#include "ligature_source_dir.hpp"
#include "protocol/device/device_file.hpp"
#include "sim_device/profile_node.hpp"

namespace ligature::sim {
namespace {

using can::Object;
using can::SdoKind;

struct Drive {
  explicit Drive(can::NodeId id) : node(id, record, constants()) { node.power_on(Time(0), out); }

  static DriveConstants constants() {
    return {.counts_per_revolution = static_cast<std::uint32_t>(std::lround(of_file().counts_per_revolution())),
            .rated_torque_mNm = static_cast<std::uint32_t>(std::lround(1e3 * of_file().rated_torque_Nm))};
  }
  static device::Device of_file() {
    return std::get<device::Device>(device::load_device(LIGATURE_SOURCE_DIR "/scenes/devices/epos4.toml"));
  }
  can::Sdo asked(const can::Frame& request) {
    out.clear();
    node.on_frame(request, Time(0), sensed, out);
    return can::decode_sdo(out.at(0)).value();
  }
  can::Sdo read(Object object) { return asked(can::sdo_read(node.id(), object)); }
  can::Sdo write(Object object, std::uint32_t value, std::uint8_t bytes) {
    return asked(can::sdo_write(node.id(), object, value, bytes));
  }
  /// Frames after a SYNC.
  std::vector<can::Frame> sync() {
    out.clear();
    node.on_frame(can::sync_frame(), Time(0), sensed, out);
    return out;
  }
  void start() { node.on_frame(can::encode_nmt(can::NmtCommand::kStart), Time(0), sensed, out); }
  void map_inputs() {
    EXPECT_EQ(write({0x1801, 1}, can::kPdoOff | kInputsId, 4).kind, SdoKind::kWritten);
    EXPECT_EQ(write({0x1A01, 1}, 0x3141'0110, 4).kind, SdoKind::kWritten);
    EXPECT_EQ(write({0x1A01, 0}, 1, 1).kind, SdoKind::kWritten);
    EXPECT_EQ(write({0x1801, 2}, 1, 1).kind, SdoKind::kWritten);
    EXPECT_EQ(write({0x1801, 1}, kInputsId, 4).kind, SdoKind::kWritten);
  }

  static constexpr std::uint32_t kInputsId = 0x283;
  device::Device record = of_file();
  ProfileNode node;
  Sensed sensed{.position_counts = 1234, .buttons = can::profile::kButtonDeadMan};
  std::vector<can::Frame> out;
};

TEST(ProfileNode, HasTheObjectsAndUnitsOfTheRecord) {
  Drive drive(can::kElbow);
  EXPECT_EQ(drive.read({0x6076, 0}).value, 75'000U) << "uN m at the motor: 0.3 N m by a gear of 4";
  EXPECT_EQ(drive.read({0x3010, 1}).value, 1024U) << "lines of four counts at the motor";
  EXPECT_EQ(drive.write({0x6076, 0}, 1, 4).value, can::sdo_abort::kReadOnly);
  for (const Object missing : {Object{0x608F, 1}, Object{0x1400, 5}, Object{0x6072, 0}, Object{0x2100, 1}})
    EXPECT_EQ(drive.read(missing).value, can::sdo_abort::kNoSuchObject) << std::hex << missing.index;
  EXPECT_EQ(drive.read({0x1016, 1}).kind, SdoKind::kValue) << "its watchdog";
  EXPECT_EQ(drive.write({0x1029, 1}, 0, 1).kind, SdoKind::kWritten) << "named by the record's writes";
  EXPECT_EQ(drive.write({0x1029, 1}, 0, 2).value, can::sdo_abort::kWrongLength);
}

TEST(ProfileNode, MapsTheInputsWhileTheirPdoIsOffAndSendsThemAtEachSync) {
  Drive drive(can::kElbow);
  EXPECT_EQ(drive.write({0x1A01, 1}, 0x3141'0110, 4).value, can::sdo_abort::kWrongDeviceState) << "the PDO is on";
  EXPECT_EQ(drive.write({0x1801, 1}, can::kPdoOff | Drive::kInputsId, 4).kind, SdoKind::kWritten);
  EXPECT_EQ(drive.write({0x1A01, 1}, 0x6041'0010, 4).value, can::sdo_abort::kCannotBeMapped);
  drive.start();
  EXPECT_EQ(drive.sync().size(), 1U) << "the inputs are not mapped";
  drive.map_inputs();
  auto sent = drive.sync();
  ASSERT_EQ(sent.size(), 2U);
  EXPECT_EQ(sent[0].id, 0x183U);
  EXPECT_EQ(can::data_word(sent[0]) >> 16U & 0xFFFF'FFFFU, 1234U);
  EXPECT_EQ(can::data_word(sent[0]) >> 48U, 0U) << "the torque, and not the buttons";
  EXPECT_EQ(sent[1].id, Drive::kInputsId);
  EXPECT_EQ(sent[1].dlc, 2);
  EXPECT_EQ(can::data_word(sent[1]), 0b10U) << "dead_man_bit 1";
  drive.node.on_frame(can::encode_nmt(can::NmtCommand::kResetNode), Time(0), drive.sensed, drive.out);
  drive.start();
  EXPECT_EQ(drive.sync().size(), 1U) << "a reset forgets the mapping";
}

TEST(ProfileNode, OnlyTheNodeOfTheRecordSendsInputs) {
  Drive drive(can::kWaist);
  EXPECT_EQ(drive.write({0x1801, 1}, can::kPdoOff | 0x281U, 4).kind, SdoKind::kWritten);
  EXPECT_EQ(drive.write({0x1A01, 1}, 0x3141'0110, 4).value, can::sdo_abort::kCannotBeMapped);
}

}  // namespace
}  // namespace ligature::sim
