// One hand with ODrive drives, with hand-made frames: samples, torques, and how the drives are switched on and off.
#include "firmware/platform/odrive_link.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "firmware/platform/make_drives.hpp"
#include "firmware/platform/odrive_time.hpp"
#include "protocol/can/bit_time.hpp"
#include "protocol/device/device_file.hpp"
#include "tests/unit/platform/fake_bus.hpp"

namespace ligature::platform {
namespace {

constexpr std::uint8_t kOn = odrive::kClosedLoop, kOff = odrive::kIdle;

device::Device shipped() {
  return std::get<device::Device>(
      device::load_device(std::string(LIGATURE_SOURCE_DIR) + "/scenes/devices/odrive.toml"));
}

can::Frame floats(std::uint32_t id, float a, float b) {
  can::Frame f{id, 8, {}};
  odrive::detail::put(f, 0, std::bit_cast<std::uint32_t>(a));
  odrive::detail::put(f, 4, std::bit_cast<std::uint32_t>(b));
  return f;
}

class Odrive : public ::testing::Test {
 protected:
  void beat(unsigned node, std::uint8_t state, std::uint32_t error = 0) {
    can::Frame f{odrive::id_of(node, odrive::Command::kHeartbeat), 8, {}};
    odrive::detail::put(f, 0, error);
    f.data[4] = state;
    bus.inbox.push_back(f);
  }
  void beat_all(std::uint8_t state) {
    for (unsigned node = 1; node <= 3; ++node) beat(node, state);
  }
  void press(std::uint8_t bits) { bus.inbox.push_back({0x201, 2, {bits, ++life}}); }
  void answer(unsigned node, float rev) {
    bus.inbox.push_back(floats(odrive::id_of(node, odrive::Command::kEstimates), rev, 0.0F));
  }
  /// One period in which the drives answer.
  rt::HandReading period(float rev = 0.5F) {
    bus.sent.clear();
    link.request();
    press(2);
    for (unsigned node = 1; node <= 3; ++node) answer(node, rev);
    link.drain();
    return link.reading();
  }
  std::ptrdiff_t sent(unsigned node, odrive::Command command) const {
    return std::ranges::count(bus.sent, odrive::id_of(node, command), &can::Frame::id);
  }
  FakeBus bus;
  device::Device device = shipped();
  OdriveLink link{bus, device};
  std::uint8_t life = 0;
};

TEST_F(Odrive, AsksByRemoteFramesAndTakesRevolutionsOfTheMotor) {
  beat_all(kOn);
  const auto r = period(0.5F);
  ASSERT_EQ(bus.sent.size(), 3U);
  EXPECT_EQ(bus.sent[1], (can::Frame{can::kRemoteBit | 0x049, 8, {}}));
  EXPECT_EQ(r.age_ticks, 0);
  EXPECT_TRUE(r.valid && r.enabled && r.dead_man);
  EXPECT_FALSE(r.drive_fault || r.grip);
  EXPECT_DOUBLE_EQ(r.q_rad[1], std::numbers::pi / 4.0) << "half a revolution of the motor through a gear of 4";
  for (const double torque : r.torque_Nm) EXPECT_TRUE(std::isnan(torque));
}

TEST_F(Odrive, ASetIsOfOneRequestAndHasButtonsThatAreNotOld) {
  (void)period();
  bus.sent.clear();
  link.request();
  answer(1, 1.0F);
  answer(2, 1.0F);
  link.drain();
  EXPECT_EQ(link.reading().age_ticks, 1);
  link.request();
  answer(3, 1.0F);
  link.drain();
  EXPECT_EQ(link.reading().age_ticks, 2) << "two of the last request and one of this are no set";
  int with_old_buttons = 0;
  for (int i = 0; i < 20; ++i) {
    link.request();
    for (unsigned node = 1; node <= 3; ++node) answer(node, 1.0F);
    link.drain();
    with_old_buttons += link.reading().age_ticks == 0 ? 1 : 0;
  }
  EXPECT_LE(with_old_buttons, 4) << "a module that fell silent must not hold the dead-man";
}

TEST_F(Odrive, AnEstimateThatIsNoNumberIsNoSample) {
  (void)period(0.5F);
  EXPECT_EQ(period(std::nanf("")).age_ticks, 1);
}

TEST_F(Odrive, ButtonsWhoseCounterStandsStillAreStuck) {
  for (int i = 0; i < 20; ++i) EXPECT_FALSE(period().buttons_stuck);
  for (int i = 0; i < 12; ++i) {
    --life;
    (void)period();
  }
  EXPECT_TRUE(link.reading().buttons_stuck);
}

TEST_F(Odrive, TorquesAreOfTheMotorAndAsRecorded) {
  beat_all(kOn);
  (void)period();
  const auto permille = link.write({{0.03, -0.3, 9.0}, rt::DriveRequest::kOperate});
  EXPECT_EQ(permille, (std::array<std::int16_t, 3>{100, -1000, 3000}));
  EXPECT_EQ(bus.sent[3], odrive::set_torque(1, 0.03F / 4.0F));
  EXPECT_EQ(bus.sent[3].dlc, 4);
  EXPECT_EQ(bus.sent[4], odrive::set_torque(2, -0.3F / 4.0F));
}

TEST_F(Odrive, ADrivesErrorAndItsSilenceAreFaults) {
  beat_all(kOn);
  EXPECT_FALSE(period().drive_fault);
  beat(2, kOff, odrive::kWatchdogExpired);
  EXPECT_TRUE(period().drive_fault);
  EXPECT_FALSE(link.reading().enabled);
  beat_all(kOn);
  EXPECT_FALSE(period().drive_fault);
  for (int i = 0; i < 120; ++i) (void)period();
  EXPECT_TRUE(link.reading().drive_fault) << "no heartbeat any more";
}

/// A torque message feeds the watchdog, also one with zero torque. A drive that does not obey must starve.
TEST_F(Odrive, SwitchesOffWithZeroTorqueThenIdleThenNothing) {
  beat_all(kOn);
  for (int i = 0; i < 100; ++i) {
    (void)period();
    EXPECT_EQ(link.write({{0.1, 0.1, 0.1}, rt::DriveRequest::kHold}), (std::array<std::int16_t, 3>{}));
    for (unsigned node = 1; node <= 3; ++node) {
      EXPECT_EQ(sent(node, odrive::Command::kSetInputTorque), i == 0 ? 1 : 0);
      EXPECT_EQ(sent(node, odrive::Command::kSetAxisState), i == 0 ? 0 : 1) << "until it says that it is off";
    }
  }
  beat_all(kOff);
  (void)period();
  link.write({{}, rt::DriveRequest::kHold});
  EXPECT_EQ(bus.sent.size(), 3U) << "requests only";
}

TEST_F(Odrive, AStopIsAnEmergencyStopInEveryPeriod) {
  beat_all(kOn);
  for (int i = 0; i < 5; ++i) {
    (void)period();
    link.write({{}, rt::DriveRequest::kStop});
    EXPECT_EQ(sent(2, odrive::Command::kEstop), i == 0 ? 0 : 1);
    beat_all(kOff);
  }
  bus.inbox.push_back(odrive::set_torque(1, 0.2F));
  OdriveLink other(bus, device);
  other.drain();
  bus.sent.clear();
  other.write({{}, rt::DriveRequest::kStop});
  EXPECT_EQ(sent(1, odrive::Command::kEstop), 1) << "at once beside another sender";
}

TEST_F(Odrive, BringsDrivesUpOneAfterTheOtherAndClearsErrors) {
  beat_all(kOff);
  beat(3, kOff, odrive::kWatchdogExpired);
  int on[4] = {}, cleared[4] = {};
  for (int i = 0; i < 41; ++i) {
    (void)period();
    link.write({{}, rt::DriveRequest::kEnable});
    for (unsigned node = 1; node <= 3; ++node) {
      on[node] += static_cast<int>(sent(node, odrive::Command::kSetAxisState));
      cleared[node] += static_cast<int>(sent(node, odrive::Command::kClearErrors));
    }
    EXPECT_LE(bus.sent.size(), 7U) << "requests, torques and one command";
  }
  EXPECT_EQ(on[1], 1);
  EXPECT_EQ(on[2], 1);
  EXPECT_EQ(on[3], 0);
  EXPECT_EQ(cleared[3], 1);
}

TEST_F(Odrive, WhatOnlyAControllerSendsIsSeenForWhatItIs) {
  using rt::Foreign;
  const std::pair<can::Frame, Foreign> all[] = {{odrive::set_torque(1, 0.0F), Foreign::kTorque},
                                                {{0x04C, 8, {}}, Foreign::kTorque},
                                                {odrive::ask_estimates(3), Foreign::kBeat},
                                                {odrive::set_axis_state(2, 8), Foreign::kNetwork},
                                                {odrive::set_torque_mode(2), Foreign::kObject},
                                                {{0x024, 8, {}}, Foreign::kObject},
                                                {{0x021, 8, {}}, Foreign::kNone},
                                                {{0x07C, 8, {}}, Foreign::kNone},
                                                {{0x201, 2, {}}, Foreign::kNone}};
  for (const auto& [frame, kind] : all) EXPECT_EQ(odrive::foreign_kind(frame), kind) << frame.id;
}

/// The figures of docs/drives.md. On average the frames of a period must fit into it.
TEST_F(Odrive, BusTimeIsThatOfThePage) {
  using std::chrono::microseconds;
  EXPECT_EQ(bus_time_of(device), (rt::BusTime{microseconds(474), microseconds(780), microseconds(0)}));
  EXPECT_EQ(odrive_torques_time(), microseconds(285));
  const auto one = [](unsigned bits) { return static_cast<double>(bits); };
  const double average = 3 * one(can::max_frame_bits(0)) + 3 * one(can::max_frame_bits(8)) +
                         one(can::max_frame_bits(2)) / 2 + 3 * one(can::max_frame_bits(4)) +
                         3 * one(can::max_frame_bits(8)) / device.odrive->heartbeat_ms;
  EXPECT_LT(average, 1000.0);
}

/// A remote frame has no data, and a data frame of the same identifier goes first.
TEST(RemoteFrame, IsShortAndComesAfterTheDataFrame) {
  const can::Frame remote = odrive::ask_estimates(1), data{remote.id & can::kMaxId, 8, {}};
  EXPECT_LE(can::frame_bits(remote), can::max_frame_bits(0));
  EXPECT_GE(can::frame_bits(remote), can::min_frame_bits(0));
  EXPECT_LT(can::rank_of(data), can::rank_of(remote));
  EXPECT_LT(can::rank_of(remote), can::rank_of({data.id + 1, 8, {}}));
}

}  // namespace
}  // namespace ligature::platform
