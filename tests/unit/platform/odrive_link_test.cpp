// One hand with ODrive drives, with hand-made frames: samples, torques, and how the drives are switched on and off.
#include "firmware/platform/odrive_link.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "firmware/platform/make_drives.hpp"
#include "firmware/platform/odrive_time.hpp"
#include "ligature_source_dir.hpp"
#include "protocol/can/bit_time.hpp"
#include "protocol/device/device_file.hpp"
#include "tests/support/random.hpp"
#include "tests/unit/platform/fake_bus.hpp"

namespace ligature::platform {
namespace {

constexpr std::uint8_t kIsOn = odrive::kClosedLoop, kIsIdle = odrive::kIdle;

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
    for (unsigned node = 1; node <= 3; ++node) answer(node, rev);
    press(2);
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
  (void)period();  // the first frame of the buttons has no counter before it
  beat_all(kIsOn);
  const auto r = period(0.5F);
  ASSERT_EQ(bus.sent.size(), 3U);
  EXPECT_EQ(bus.sent[1], (can::Frame{can::kRemoteBit | 0x049, 8, {}}));
  EXPECT_EQ(r.age_ticks, 0);
  EXPECT_TRUE(r.valid && r.enabled && r.dead_man);
  EXPECT_FALSE(r.drive_fault || r.grip);
  EXPECT_DOUBLE_EQ(r.q_rad[1], std::numbers::pi) << "half a turn";
  for (const double torque : r.torque_Nm) EXPECT_TRUE(std::isnan(torque));
}

TEST_F(Odrive, ASetHasAllAnswersToTheRequestsOfOnePeriod) {
  (void)period();
  for (unsigned missing = 1; missing <= 4; ++missing) {
    link.request();
    for (unsigned node = 1; node <= 3; ++node)
      if (node != missing) answer(node, 1.0F);
    if (missing != 4) press(2);
    link.drain();
    EXPECT_GE(link.reading().age_ticks, 1) << missing;
    for (int i = 0; i < 3; ++i) (void)period();
    EXPECT_EQ(link.reading().age_ticks, 0) << missing;
  }
}

/// Answers are late by any number of periods. An answer that comes after the next period has begun must never be a
/// sample of that period: it would be an old pose that counts as new.
TEST_F(Odrive, ALateAnswerIsNoNewSample) {
  test::Random random(15);
  struct Answer {
    unsigned node;
    int asked, due;
  };
  std::vector<Answer> under_way;
  (void)period();
  int fresh = 0;
  for (int k = 0; k < 3000; ++k) {
    bus.sent.clear();
    link.request();
    for (unsigned node = 1; node <= 4; ++node) {  // 4: the button module
      const bool asked = std::ranges::count(bus.sent, odrive::ask(std::min(node, 3U), odrive::Command::kEstimates)) > 0;
      const auto late = static_cast<int>(random.happens(0.2) ? random.any(1, 2) : 0);
      if (asked) under_way.push_back({node, k, k + late});
    }
    for (const Answer& a : under_way) {
      if (a.due != k) continue;
      if (a.node == 4)
        press(2);
      else
        answer(a.node, static_cast<float>(a.asked));
    }
    std::erase_if(under_way, [k](const Answer& a) { return a.due <= k; });
    link.drain();
    const auto r = link.reading();
    if (r.age_ticks != 0) continue;
    ++fresh;
    for (const double q : r.q_rad) ASSERT_EQ(q, static_cast<float>(k) * 2.0 * std::numbers::pi) << k;
  }
  EXPECT_GT(fresh, 500);
}

TEST_F(Odrive, AnAnswerThatNobodyAskedForIsNoSample) {
  (void)period();
  (void)period(0.5F);
  for (unsigned node = 1; node <= 3; ++node) answer(node, 0.9F);
  press(0);
  link.drain();
  EXPECT_EQ(link.reading().q_rad[0], std::numbers::pi);
  EXPECT_TRUE(link.reading().dead_man);
  EXPECT_TRUE(link.reading().drive_fault) << "two drives with one node id, or a cyclic message";
}

TEST_F(Odrive, ALostAnswerIsGivenUpAfterTwoSilentPeriods) {
  (void)period();
  link.request();
  link.drain();
  int asked = 0;
  for (int k = 0; k < 3; ++k) {
    bus.sent.clear();
    link.request();
    EXPECT_EQ(bus.sent.size(), k == 2 ? 3U : 0U) << k;
    asked += static_cast<int>(bus.sent.size());
  }
  EXPECT_EQ(asked, 3);
}

TEST_F(Odrive, AnEstimateThatIsNoNumberIsNoSample) {
  (void)period();
  (void)period(0.5F);
  EXPECT_EQ(period(std::nanf("")).age_ticks, 1);
  EXPECT_EQ(link.reading().q_rad[0], std::numbers::pi);
}

TEST_F(Odrive, ButtonsWhoseCounterStandsStillAreStuck) {
  for (int i = 0; i < 20; ++i) EXPECT_FALSE(period().buttons_stuck);
  for (int i = 0; i < 12; ++i) {
    --life;
    EXPECT_GE(period().age_ticks, 1) << "no sample";
  }
  EXPECT_TRUE(link.reading().buttons_stuck);
}

TEST_F(Odrive, TorquesAreOfTheMotorAndAsRecorded) {
  beat_all(kIsOn);
  (void)period();
  const auto permille = link.write({{0.03, -0.3, 9.0}, rt::DriveRequest::kOperate});
  EXPECT_EQ(permille, (std::array<std::int16_t, 3>{100, -1000, 3000}));
  EXPECT_EQ(bus.sent[3], odrive::set_torque(1, 0.03F));
  EXPECT_EQ(bus.sent[3].dlc, 4);
  EXPECT_EQ(bus.sent[4], odrive::set_torque(2, -0.3F));
}

TEST_F(Odrive, ADrivesErrorAndItsSilenceAreFaults) {
  beat_all(kIsOn);
  EXPECT_FALSE(period().drive_fault);
  beat(2, kIsIdle, odrive::kWatchdogExpired);
  const auto r = period();
  EXPECT_TRUE(r.drive_fault);
  EXPECT_EQ(r.bad_joint, 1);
  EXPECT_EQ(r.drive_error, std::uint32_t{odrive::kWatchdogExpired});
  EXPECT_FALSE(link.reading().enabled);
  link.write({{}, rt::DriveRequest::kOperate});
  beat_all(kIsOn);
  EXPECT_FALSE(period().drive_fault);
  for (int i = 1; i <= 31; ++i) EXPECT_EQ(period().drive_fault, i > 30 - 1) << "three heartbeats stayed away: " << i;
  beat_all(kIsOn);
  EXPECT_TRUE(period().drive_fault) << "until a restart";
}

/// Any frame may reset a drive's watchdog, even a request. So the link sends nothing more to a drive that does not
/// obey, and the drive's watchdog switches it off.
TEST_F(Odrive, SwitchesOffWithZeroTorqueThenIdleThenNothing) {
  beat_all(kIsOn);
  for (int i = 0; i < 100; ++i) {
    (void)period();
    EXPECT_EQ(link.write({{0.1, 0.1, 0.1}, rt::DriveRequest::kHold}), (std::array<std::int16_t, 3>{}));
    const bool idles = i % 34 == 1;  // again after the watchdog of 20 ms, a heartbeat and four periods
    EXPECT_EQ(bus.sent.size(), i == 0 ? 6U : idles ? 3U : 0U) << i;
    for (unsigned node = 1; node <= 3; ++node) {
      EXPECT_EQ(sent(node, odrive::Command::kSetInputTorque), i == 0 ? 1 : 0);
      EXPECT_EQ(sent(node, odrive::Command::kSetAxisState), idles ? 1 : 0) << i;
    }
    if (i == 50) beat(1, kIsIdle);
    if (i == 60) beat(2, kIsIdle);
  }
  beat_all(kIsIdle);
  (void)period();
  link.write({{}, rt::DriveRequest::kHold});
  EXPECT_EQ(bus.sent.size(), 0U);
  (void)period();
  EXPECT_EQ(bus.sent.size(), 3U) << "all have said that they are off: requests";
}

/// A heartbeat that was sent before the drive was told to be off says nothing.
TEST_F(Odrive, AHeartbeatFromBeforeIdleIsNoAnswer) {
  for (int early = 0; early < 5; ++early) {
    OdriveLink other(bus, device);
    bool asks = false;
    for (int i = 0; i < 8 && !asks; ++i) {
      bus.sent.clear();
      other.request();
      asks = i > 0 && !bus.sent.empty();
      if (i == early) beat_all(kIsIdle);
      other.drain();
      other.write({{}, rt::DriveRequest::kHold});
    }
    EXPECT_EQ(asks, early >= 2) << early;
  }
}

TEST_F(Odrive, AStopIsAnEmergencyStopInEveryPeriodWhileAnotherControllerSends) {
  beat_all(kIsOn);
  for (int i = 0; i < 100; ++i) {
    if (i < 20) bus.inbox.push_back(odrive::set_torque(1, 0.2F));
    (void)period();
    link.write({{}, rt::DriveRequest::kStop});
    const bool again = i > 27 && (i - 27) % 34 == 0;
    EXPECT_EQ(sent(2, odrive::Command::kEstop), i <= 27 || again ? 1 : 0) << i;
    beat_all(kIsIdle);
  }
  bus.inbox.push_back(odrive::set_torque(1, 0.2F));
  OdriveLink other(bus, device);
  other.drain();
  bus.sent.clear();
  other.write({{}, rt::DriveRequest::kStop});
  EXPECT_EQ(sent(1, odrive::Command::kEstop), 1) << "at once beside another sender";
}

/// While a fault is latched, the controller goes on to ask for kHold. The other one could switch the drives on again.
TEST_F(Odrive, AnotherControllerDuringAFaultMeetsEmergencyStopsToo) {
  beat_all(kIsOn);
  for (int i = 0; i < 70; ++i) {
    if (i >= 50) bus.inbox.push_back(odrive::set_torque(1, 0.2F));
    (void)period();
    link.write({{}, rt::DriveRequest::kHold});
    EXPECT_EQ(sent(2, odrive::Command::kEstop), i >= 50 ? 1 : 0) << i;
  }
}

TEST_F(Odrive, BringsDrivesUpOneAfterTheOtherAndClearsErrors) {
  beat_all(kIsIdle);
  beat(3, kIsIdle, odrive::kWatchdogExpired);
  int on[4] = {}, cleared[4] = {};
  for (int i = 0; i < 29; ++i) {
    (void)period();
    link.write({{}, rt::DriveRequest::kEnable});
    for (unsigned node = 1; node <= 3; ++node) {
      on[node] += static_cast<int>(sent(node, odrive::Command::kSetAxisState));
      cleared[node] += static_cast<int>(sent(node, odrive::Command::kClearErrors));
      EXPECT_EQ(sent(node, odrive::Command::kSetControllerMode), i == 3 * (static_cast<int>(node) - 1) && node < 3);
      EXPECT_EQ(sent(node, odrive::Command::kSetLimits), i == 3 * (static_cast<int>(node) - 1) + 1 && node < 3);
    }
    EXPECT_LE(bus.sent.size(), 7U) << "requests, torques and one command";
  }
  EXPECT_EQ(on[1], 1);
  EXPECT_EQ(on[2], 1);
  EXPECT_EQ(on[3], 0);
  EXPECT_EQ(cleared[3], 1);
}

/// A drive whose mode or limits the bus did not take is not switched on.
TEST_F(Odrive, NoClosedLoopAfterACommandThatTheBusRefused) {
  for (const long command : {0, 1}) {
    OdriveLink other(bus, device);
    beat_all(kIsIdle);
    for (int i = 0; i < 3; ++i) {
      bus.sent.clear();
      other.request();
      bus.refuse_at = i == command ? 3 : -1;  // after the three torques
      other.write({{}, rt::DriveRequest::kEnable});
      EXPECT_EQ(sent(1, odrive::Command::kSetAxisState), 0) << command;
    }
  }
}

TEST_F(Odrive, WhatOnlyAControllerSendsIsSeenForWhatItIs) {
  using rt::Foreign;
  const std::pair<can::Frame, Foreign> all[] = {{odrive::set_torque(1, 0.0F), Foreign::kTorque},
                                                {{0x04C, 8, {}}, Foreign::kTorque},
                                                {odrive::ask(3, odrive::Command::kEstimates), Foreign::kBeat},
                                                {odrive::set_axis_state(2, 8), Foreign::kNetwork},
                                                {odrive::set_torque_mode(2), Foreign::kObject},
                                                {{0x024, 8, {}}, Foreign::kObject},
                                                {{0x7EE, 4, {}}, Foreign::kTorque},  // to all nodes
                                                {{0x7E7, 8, {}}, Foreign::kNetwork},
                                                {{0x7EB, 8, {}}, Foreign::kObject},
                                                {{0x7E1, 8, {}}, Foreign::kObject},
                                                {{0x7DF, 8, {}}, Foreign::kNone},
                                                {{0x029, 0, {}}, Foreign::kBeat},  // a request without a remote frame
                                                {{0x036, 1, {}}, Foreign::kNetwork},
                                                {{0x021, 8, {}}, Foreign::kNone},
                                                {{0x07C, 8, {}}, Foreign::kNone},
                                                {{0x201, 2, {}}, Foreign::kNone}};
  for (const auto& [frame, kind] : all) EXPECT_EQ(odrive::foreign_kind(frame), kind) << frame.id;
}

/// The figures of docs/drives.md. The frames of a period must fit into it, also with the most stuff bits.
TEST_F(Odrive, BusTimeIsThatOfThePage) {
  using std::chrono::microseconds;
  EXPECT_EQ(bus_time_of(device), (rt::BusTime{microseconds(537), microseconds(780), microseconds(0)}));
  EXPECT_EQ(odrive_torques_time(), microseconds(285));
  const unsigned most =
      3 * can::max_frame_bits(0) + 3 * can::max_frame_bits(8) + can::max_frame_bits(2) + 3 * can::max_frame_bits(4);
  EXPECT_LT(most + 3.0 * can::max_frame_bits(8) / device.odrive->heartbeat_ms, 1000.0);
}

/// A remote frame has no data, and a data frame of the same identifier goes first.
TEST(RemoteFrame, IsShortAndComesAfterTheDataFrame) {
  const can::Frame remote = odrive::ask(1, odrive::Command::kEstimates), data{remote.id & can::kMaxId, 8, {}};
  EXPECT_LE(can::frame_bits(remote), can::max_frame_bits(0));
  EXPECT_GE(can::frame_bits(remote), can::min_frame_bits(0));
  EXPECT_LT(can::rank_of(data), can::rank_of(remote));
  EXPECT_LT(can::rank_of(remote), can::rank_of({data.id + 1, 8, {}}));
}

}  // namespace
}  // namespace ligature::platform
