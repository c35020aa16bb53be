// The bridge's drives on their bus, in virtual time.
#include "bridge/drives.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "ligature_source_dir.hpp"
#include "protocol/can/codec.hpp"
#include "protocol/can/sdo.hpp"
#include "protocol/device/device_file.hpp"

namespace ligature::bridge {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
constexpr int kClient = sim::HandDevice::kFirstClient;
constexpr Time kSilence = milliseconds(20);

device::Device record() {
  const auto read = device::load_device(LIGATURE_SOURCE_DIR "/scenes/devices/inverse3.toml");
  EXPECT_TRUE(std::holds_alternative<device::Device>(read));
  return std::get<device::Device>(read);
}

/// A minimal master: starts the drives and sends SYNC and torques each millisecond.
class BridgeDrives : public ::testing::Test {
 protected:
  void send(const can::Frame& frame) { drives_.submit(frame, kClient, now_); }

  void run(Time time, bool is_heard = true) {
    for (const Time end = now_ + time; now_ < end; now_ += microseconds(100)) {
      if (is_heard) drives_.take(state_, now_);
      drives_.advance(now_);
      for (const auto& delivery : drives_.deliveries())
        if (delivery.sender < kClient) heard_.push_back(delivery.frame);
      drives_.deliveries().clear();
    }
  }

  void period(std::uint16_t controlword, std::array<std::int16_t, 3> torques = {}, bool is_heard = true) {
    heard_.clear();
    send(can::sync_frame());
    run(microseconds(500), is_heard);
    for (std::size_t i = 0; i < 3; ++i) send(can::encode(drives_.nodes()[i].id(), can::Rpdo1{controlword, torques[i]}));
    run(microseconds(500), is_heard);
  }

  void write(can::NodeId node, can::Object object, std::uint32_t value, std::uint8_t bytes) {
    send(can::sdo_write(node, object, value, bytes));
    run(milliseconds(1));
  }

  void bring_up() {
    run(milliseconds(5));
    for (const auto& node : drives_.nodes())
      write(node.id(), can::od::kModeOfOperation, static_cast<std::uint32_t>(can::profile::kCyclicSynchronousTorque),
            1);
    send(can::encode_nmt(can::NmtCommand::kStart));
    run(milliseconds(1));
    for (const int word : {0x06, 0x07, 0x0F, 0x0F}) period(static_cast<std::uint16_t>(word));
    for (const auto& node : drives_.nodes()) ASSERT_EQ(node.state(), can::cia402::State::kOperationEnabled);
  }

  std::optional<can::Tpdo1> tpdo(can::NodeId node) const {
    for (const auto& frame : heard_)
      if (const auto read = can::decode_tpdo1(node, frame)) return read;
    return std::nullopt;
  }

  device::Device record_ = record();
  Time now_ = milliseconds(1);
  Drives drives_{record_, now_, kSilence};
  DeviceState state_{{0.0, -0.12, 0.15}, 0};
  std::vector<can::Frame> heard_;
};

TEST_F(BridgeDrives, ThePositionBecomesCountsAndTheButtonsAreSent) {
  bring_up();
  state_ = {{0.03, -0.12, 0.10}, can::profile::kButtonDeadMan};
  period(0x0F);
  const double m_per_count = 0.02 * record_.rad_per_count();
  const std::array<double, 3> wanted_m{0.03, 0.0, -0.05};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto sample = tpdo(drives_.nodes()[i].id());
    ASSERT_TRUE(sample) << i;
    EXPECT_NEAR(sample->position_counts * m_per_count, wanted_m[i], m_per_count) << i;
  }
  EXPECT_EQ(tpdo(can::kElbow)->buttons & 7, can::profile::kButtonDeadMan);
}

TEST_F(BridgeDrives, TorquesBecomeTheForceAfterTheNextSync) {
  bring_up();
  period(0x0F, {100, -200, 300});
  EXPECT_EQ(drives_.force_D_N(), (Vec{0.0, 0.0, 0.0}));  // they came after this period's SYNC
  period(0x0F, {0, 0, 0});
  const double N_per_permille = record_.rated_torque_Nm * 1e-3 / 0.02;
  const Vec force = drives_.force_D_N();
  for (const auto& [i, permille] : {std::pair{0, 100}, {1, -200}, {2, 300}})
    EXPECT_NEAR(force[static_cast<std::size_t>(i)], permille * N_per_permille, 1e-12);
  period(0x0F);
  EXPECT_EQ(drives_.force_D_N(), (Vec{0.0, 0.0, 0.0}));
}

TEST_F(BridgeDrives, ASilentDeviceIsADriveWithoutPower) {
  bring_up();
  period(0x0F, {100, 0, 0});
  period(0x0F, {100, 0, 0});
  ASSERT_NE(drives_.force_D_N()[0], 0.0);
  Time silent = Time(0);
  for (; drives_.is_heard() && silent < milliseconds(100); silent += milliseconds(1)) period(0x0F, {100, 0, 0}, false);
  EXPECT_LE(silent, kSilence + milliseconds(1));
  EXPECT_GE(silent, kSilence - milliseconds(1));
  EXPECT_EQ(drives_.force_D_N(), (Vec{0.0, 0.0, 0.0}));
  period(0x0F, {100, 0, 0}, false);
  EXPECT_TRUE(heard_.empty());  // no answer to SYNC, no heartbeat
  period(0x0F, {100, 0, 0});    // heard again: the drives start up, and wait to be enabled
  EXPECT_TRUE(drives_.is_heard());
  EXPECT_EQ(drives_.force_D_N(), (Vec{0.0, 0.0, 0.0}));
  for (const auto& node : drives_.nodes()) EXPECT_EQ(node.nmt_state(), can::NmtState::kPreOperational);
  for (int i = 0; i < 10; ++i) period(0x0F, {100, 0, 0});
  EXPECT_EQ(drives_.force_D_N(), (Vec{0.0, 0.0, 0.0}));
}

/// An old state of the device must not be sent as a sample, even if the device may be silent for long before it counts
/// as lost. So the firmware sees missing samples and applies its watchdog's limit, as for any drive whose messages are
/// lost. Otherwise a release of the dead-man could stay hidden for longer than that limit.
TEST_F(BridgeDrives, AnOldStateIsNoSample) {
  drives_ = Drives(record_, now_, std::chrono::seconds(1));
  state_.buttons = can::profile::kButtonDeadMan;
  bring_up();
  period(0x0F, {100, 0, 0});
  ASSERT_TRUE(tpdo(can::kElbow));
  const Time oldest = Drives::oldest_sample(record_);
  EXPECT_EQ(oldest, microseconds(1500)) << "delay_s of the record, less the period of the loop";
  const Time last = now_;
  Time answered = last;
  for (int i = 0; i < 100; ++i) {
    const Time sync = now_;
    period(0x0F, {100, 0, 0}, false);
    if (tpdo(can::kWaist) || tpdo(can::kElbow)) answered = sync;
  }
  EXPECT_LE(answered - last, oldest);
  EXPECT_TRUE(drives_.is_heard());
  EXPECT_NE(drives_.force_D_N()[0], 0.0) << "the drives still obey";
  period(0x00, {0, 0, 0}, false);
  period(0x00, {0, 0, 0}, false);
  EXPECT_EQ(drives_.force_D_N(), (Vec{0.0, 0.0, 0.0}));
  period(0x00);
  EXPECT_TRUE(tpdo(can::kElbow)) << "it is back";
}

TEST_F(BridgeDrives, WithoutADeviceThereAreNoDrives) {
  run(milliseconds(50), false);
  period(0x0F, {100, 100, 100}, false);
  EXPECT_TRUE(heard_.empty());
  EXPECT_FALSE(drives_.is_heard());
}

TEST_F(BridgeDrives, AFirmwareThatFallsSilentLeavesNoForce) {
  bring_up();
  for (const auto& node : drives_.nodes()) write(node.id(), can::od::kRpdo1EventTimer, 20, 2);
  period(0x0F, {100, 0, 0});
  period(0x0F, {100, 0, 0});
  ASSERT_NE(drives_.force_D_N()[0], 0.0);
  run(milliseconds(21));
  EXPECT_EQ(drives_.force_D_N(), (Vec{0.0, 0.0, 0.0}));
}

/// The age of the newest state at the end of SYNC (the delay in docs/bridge.md) is at most one exchange period plus the
/// length of the SYNC frame. Tested with a state every 0.5 ms, at every phase between the two clocks.
TEST(BridgeDelay, AStateIsNeverOlderThanAnExchangePeriodAtSync) {
  constexpr Time kExchange = microseconds(500), kSync = microseconds(50);
  Time worst{}, least = milliseconds(1);
  for (Time phase{}; phase < kExchange; phase += microseconds(20)) {
    Drives drives(record(), Time(0), kSilence);
    Time next = phase;
    for (Time now{}; now < milliseconds(50); now += microseconds(10)) {
      if (now >= next) {
        drives.take({}, now);
        next += kExchange;
      }
      if (now % milliseconds(1) == Time(0)) drives.submit(can::sync_frame(), kClient, now);
      drives.advance(now);
      drives.deliveries().clear();
    }
    worst = std::max(worst, drives.ages().worst);
    least = std::min(least, drives.ages().worst);
  }
  EXPECT_LE(worst, kExchange + kSync);
  EXPECT_GT(worst, kExchange - microseconds(40));
  EXPECT_LT(least, kSync + microseconds(20));
}

TEST(BridgeRecord, OnlyACartesianDeviceCanBeBridged) {
  EXPECT_EQ(objection_to(record(), microseconds(500)), "");
  EXPECT_NE(objection_to(device::omni(), microseconds(500)), "");
  EXPECT_NE(objection_to(record(), milliseconds(5)).find("drives.delay_s: found 0.0025, allowed more than"),
            std::string::npos)
      << "most samples would be missing";
}

}  // namespace
}  // namespace ligature::bridge
