// A hand whose drives are described by a device record: start-up, buttons, watchdog, and functions that such drives
// lack.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>

#include "firmware/platform/cia402_facts.hpp"
#include "firmware/platform/cia402_time.hpp"
#include "firmware/platform/make_drives.hpp"
#include "ligature_source_dir.hpp"
#include "protocol/can/cia402.hpp"
#include "protocol/can/codec.hpp"
#include "protocol/can/heartbeat.hpp"
#include "protocol/can/nmt.hpp"
#include "protocol/can/sdo.hpp"
#include "protocol/device/device_file.hpp"
#include "tests/unit/platform/fake_bus.hpp"

namespace ligature::platform {
namespace {

device::Device shipped(const std::string& file) {
  return std::get<device::Device>(device::load_device(std::string(LIGATURE_SOURCE_DIR) + "/scenes/devices/" + file));
}

/// Drives that answer every SDO with success, except for objects that they do not have.
class Profile : public ::testing::Test {
 protected:
  void SetUp() override {
    bus.on_send = [this](const can::Frame& f) {
      const auto request = can::decode_sdo(f);
      if (!request) return;
      can::Sdo reply{can::SdoKind::kWritten, request->node, request->object, 0, 0};
      if (missing.contains(request->object))
        reply = {can::SdoKind::kAbort, request->node, request->object, can::sdo_abort::kNoSuchObject, 0};
      else if (request->kind == can::SdoKind::kRead)
        reply = {can::SdoKind::kValue, request->node, request->object,
                 request->object.index == 0x6076   ? rated_torque
                 : request->object.index == 0x6061 ? 10U
                                                   : counts,
                 4};
      else
        written.push_back(*request);
      bus.inbox.push_back(can::encode(reply));
    };
  }
  std::optional<std::string> configure() { return drives->configure(wait); }
  bool wrote(std::uint8_t node, can::Object object, std::uint32_t value) const {
    return std::ranges::any_of(
        written, [&](const can::Sdo& s) { return s.node.value == node && s.object == object && s.value == value; });
  }
  /// One period in which the drives answer; with `inputs` also the buttons.
  rt::HandReading period(std::optional<std::uint16_t> inputs, std::uint16_t statusword = 0x27) {
    drives->request();
    for (const auto node : can::profile::kJointNodes) {
      can::Frame f = can::encode(can::kWaist, can::Tpdo1{statusword, 100, 7, 0});
      f.id = can::cob_id(can::Service::kTpdo1, node).value;
      bus.inbox.push_back(f);
    }
    if (inputs) bus.inbox.push_back({0x283, 2, {static_cast<std::uint8_t>(*inputs), 0}});
    drives->drain();
    return drives->reading();
  }

  FakeBus bus;
  FakeWait wait;
  device::Device epos4 = shipped("epos4.toml");
  std::unique_ptr<HandDrives> drives = make_drives(bus, epos4, 20, 0);
  std::uint32_t rated_torque = 75000, counts = 1024;
  std::set<can::Object> missing;
  std::vector<can::Sdo> written;
};

TEST_F(Profile, MapsTheButtonsOfItsNodeInATpdoOfTheirOwnAndTheTorqueOfEveryJoint) {
  ASSERT_EQ(configure(), std::nullopt);
  for (const std::uint8_t node : std::array<std::uint8_t, 3>{1, 2, 3}) {
    EXPECT_TRUE(wrote(node, {0x1A00, 3}, 0x6077'0010));
    EXPECT_EQ(wrote(node, {0x1A01, 1}, 0x3141'0110), node == 3);
    EXPECT_EQ(wrote(node, {0x1801, 1}, 0x280U + node), node == 3);
    for (const std::uint16_t other : std::array<std::uint16_t, 5>{0x1401, 0x1402, 0x1403, 0x1802, 0x1803})
      EXPECT_TRUE(std::ranges::any_of(written, [&](const can::Sdo& s) {
        return s.node.value == node && s.object == can::Object{other, 1} && s.value >> 31U == 1U;
      })) << "a PDO that nobody reads would fill the bus";
    EXPECT_TRUE(wrote(node, {0x1016, 1}, can::consumer_heartbeat_value(can::kMasterNode, 40)));
    EXPECT_TRUE(wrote(node, {0x1800, 3}, 0));
  }
  for (const can::Sdo& s : written) {
    EXPECT_NE(s.object, (can::Object{0x1400, 5}));
    EXPECT_NE(s.object.index, 0x6072);
  }
}

TEST_F(Profile, ValuesInOtherUnitsAreRefused) {
  rated_torque = 75;
  EXPECT_EQ(configure(), "node 1, object 0x6076:00: found 75, allowed 75000");
  rated_torque = 75000, counts = 4096;
  EXPECT_EQ(configure(), "node 1, object 0x3010:01: found 4096, allowed 1024");
}

TEST_F(Profile, OnlyWhatTheRecordCallsOptionalMayBeMissing) {
  missing = {{0x6007, 0}};
  EXPECT_EQ(configure(), "node 1, object 0x6007:00: refused by the drive, abort code 0x06020000");
  epos4.cia402.optional = {{0x6007, 0}};
  drives = make_drives(bus, epos4, 20, 0);
  EXPECT_EQ(configure(), std::nullopt);
  const auto lacks = drives->lacks();
  for (const char* node : {"node 1", "node 2", "node 3"})
    EXPECT_TRUE(std::ranges::count(
        lacks, std::string(node) + ", object 0x6007:00: missing in this drive, optional in its record"));
}

/// Angles without the buttons' message are no sample: the controller would not know of a released dead-man.
TEST_F(Profile, ASetIsCompleteOnlyWithItsButtons) {
  EXPECT_EQ(period(0b010).age_ticks, 0);
  EXPECT_TRUE(drives->is_settled());
  EXPECT_TRUE(drives->reading().dead_man);
  EXPECT_FALSE(drives->reading().grip || drives->reading().clutch);
  EXPECT_EQ(period(std::nullopt).age_ticks, 1);
  EXPECT_FALSE(drives->is_settled());
  EXPECT_FALSE(period(0b101).dead_man);
  EXPECT_TRUE(drives->reading().grip && drives->reading().clutch);
}

TEST_F(Profile, EveryJointTellsItsTorqueAndAMakersBitMeansNothing) {
  const auto r = period(0, 0x27 | can::cia402::kTorqueAstrayBit);
  for (const double torque : r.torque_Nm) EXPECT_NEAR(torque, 7 * 0.3e-3, 1e-12);
  EXPECT_EQ(r.torque_astray, (std::array<bool, 3>{}));
  EXPECT_FALSE(period(0).buttons_stuck);
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(period(2).buttons_stuck) << "there is no sign of life to miss";
}

TEST_F(Profile, AHeartbeatThatIsTheOnlyWatchdogIsSentFourTimesInItsTime) {
  int beats = 0;
  for (int i = 0; i < 100; ++i) {
    bus.sent.clear();
    (void)period(0);
    (void)drives->write({{}, rt::DriveRequest::kOperate});
    beats += static_cast<int>(
        std::ranges::count(bus.sent, can::encode(can::Heartbeat{can::kMasterNode, can::NmtState::kOperational})));
  }
  EXPECT_EQ(beats, 10) << "every 10 ms for 40 ms";
}

TEST_F(Profile, BusTimeCountsButtonsAndHeartbeats) {
  const auto own = bus_time_of(device::omni()), theirs = bus_time_of(epos4);
  EXPECT_EQ(own, cia402_time());
  EXPECT_EQ(theirs.samples_latest - own.samples_latest,
            std::chrono::nanoseconds(can::bits_to_ns(can::max_frame_bits(2))));
  EXPECT_EQ(theirs.torques_latest - own.torques_latest,
            std::chrono::nanoseconds(can::bits_to_ns(can::max_frame_bits(1))));
  EXPECT_EQ(drives->example_samples().size(), 4U);
  EXPECT_GT(theirs.most_work(), std::chrono::microseconds(100)) << "what is left to the loop";
}

/// The figures of docs/drives.md.
TEST(DriveTimes, AreThoseOfThePage) {
  using std::chrono::microseconds;
  const std::pair<const char*, rt::BusTime> all[] = {
      {"omni.toml", {microseconds(380), microseconds(460), microseconds(285)}},
      {"epos4.toml", {microseconds(443), microseconds(535), microseconds(350)}},
      {"generic-cia402.toml", {microseconds(459), microseconds(555), microseconds(350)}}};
  for (const auto& [file, time] : all) {
    EXPECT_EQ(bus_time_of(shipped(file)), time) << file;
    EXPECT_LT(time.samples_latest, time.longest_wait()) << "the loop waits until all samples can be there";
  }
}

TEST(DriveLacks, ADriveWithoutAWatchdogIsNamed) {
  device::Device d = device::omni();
  EXPECT_TRUE(lacks_of(d, 20).empty());
  EXPECT_TRUE(have_watchdog(d));
  d.cia402.watchdog = device::DriveWatchdog::kNone;
  EXPECT_FALSE(have_watchdog(d));
  ASSERT_EQ(lacks_of(d, 20).size(), 1U);
  EXPECT_NE(lacks_of(d, 20)[0].find("the last torque acts until the power is cut"), std::string::npos);
  for (const can::SdoWrite& w : can::startup_plan(can::kWaist, startup_times(d, 20))) {
    EXPECT_NE(w.object, can::od::kRpdo1EventTimer);
    EXPECT_NE(w.object, can::od::kConsumerHeartbeat);
  }
}

}  // namespace
}  // namespace ligature::platform
