// A scripted master enables the three drives and moves them over the simulated, loaded bus in virtual time.

#include "sim_device/hand_device.hpp"

#include <gtest/gtest.h>

#include "tests/unit/sim_device/omni.hpp"
#include "tests/unit/sim_device/virtual_master.hpp"

namespace ligature::sim {
namespace {

using can::cia402::State;
using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr Time kStart = std::chrono::seconds(100);
const std::vector<scene::GripKey> kUpAndDown{
    {0.0, {0.5, -0.4, 3.2}, true}, {0.5, {0.5, -0.4, 3.6}, true}, {1.0, {0.5, -0.4, 3.2}, false}};

struct Rig {
  explicit Rig(const std::vector<scene::GripKey>& keys = {}) : device(path_of(keys), kStart), master(device, kStart) {}
  void ticks(int n, const std::array<std::int16_t, 3>& torque = {}) {
    for (int i = 0; i < n; ++i) master.tick(torque);
  }
  HandDevice device;
  VirtualMaster master;
};

TEST(HandDevice, StartsUpAndIsEnabledInSevenTicks) {  // three transitions, each visible two SYNCs after its command
  Rig r;
  ASSERT_TRUE(r.master.start_up());
  EXPECT_TRUE(r.master.enable(7));
  EXPECT_TRUE(r.device.mechanics().has_started());
}

TEST(HandDevice, AllTpdosArriveWithin460MicrosecondsOfTheSync) {
  Rig r;
  ASSERT_TRUE(r.master.start_up());
  ASSERT_TRUE(r.master.enable());
  r.master.tpdo_times.clear();
  r.ticks(500, {100, -200, 300});
  ASSERT_EQ(r.master.tpdo_times.size(), 1500U);
  for (const Time t : r.master.tpdo_times) EXPECT_LE(t, microseconds(3 * 135 + 5));
}

// 61.7 .. 74.5 % for the tick's frames, depending on stuff bits; heartbeats add 0.3 %
TEST(HandDevice, BusLoadLiesWhereTheBitsSay) {
  Rig r;
  ASSERT_TRUE(r.master.start_up());
  r.ticks(2000, {123, -456, 789});
  EXPECT_GT(r.device.bus_load(), 0.617);
  EXPECT_LT(r.device.bus_load(), 0.748);
  EXPECT_EQ(r.device.bus_stats().missed_syncs, 0);
  EXPECT_LT(r.device.bus_stats().worst_rpdo, milliseconds(1));
}

TEST(HandDevice, PositiveTorqueTurnsEachJointPositive) {  // torque of at most 0.3 N m, against the resting hand
  for (std::size_t joint = 0; joint < 3; ++joint) {
    Rig r;
    ASSERT_TRUE(r.master.start_up());
    ASSERT_TRUE(r.master.enable());
    const auto before = r.master.tpdo;
    std::array<std::int16_t, 3> torque{};
    torque[joint] = 1000;
    r.ticks(300, torque);
    EXPECT_GT(r.master.tpdo[joint].position_counts, before[joint].position_counts + 10) << joint;
  }
}

TEST(HandDevice, EncodersFollowTheOperator) {
  Rig r(kUpAndDown);
  ASSERT_TRUE(r.master.start_up());
  ASSERT_TRUE(r.master.enable());
  r.ticks(500);
  const Vec3 q{can::angle_rad(r.master.tpdo[0].position_counts), can::angle_rad(r.master.tpdo[1].position_counts),
               can::angle_rad(r.master.tpdo[2].position_counts)};
  EXPECT_NEAR((tip_D_m(q) - Vec3(0.0, -0.17, 0.02)).norm(), 0.0, 1e-3);  // z: 0.4 m in the world / scale 20
  EXPECT_EQ(r.master.tpdo[2].buttons & 0xFF, can::profile::kButtonGrip | can::profile::kButtonDeadMan);
  r.ticks(600);
  EXPECT_EQ(r.master.tpdo[2].buttons & 0xFF, can::profile::kButtonDeadMan);
  r.ticks(1000);
  EXPECT_EQ(r.master.tpdo[2].buttons & 0xFF, 0);
  EXPECT_TRUE(r.device.mechanics().is_done());
}

TEST(HandDevice, ASilentMasterLeavesNoTorqueAndThreeFaults) {
  Rig r;
  ASSERT_TRUE(r.master.start_up({.rpdo_timeout_ms = 20}));
  ASSERT_TRUE(r.master.enable());
  r.ticks(10, {500, 500, 500});
  EXPECT_EQ(r.device.torque_permille(), (std::array<std::int16_t, 3>{500, 500, 500}));
  r.master.pass(milliseconds(19));
  EXPECT_EQ(r.device.torque_permille(), (std::array<std::int16_t, 3>{500, 500, 500}));
  r.master.pass(milliseconds(3));
  EXPECT_EQ(r.device.torque_permille(), (std::array<std::int16_t, 3>{0, 0, 0}));
  EXPECT_EQ(r.master.emergencies.size(), 3U);
}

TEST(HandDevice, RecoversByFaultResetOnly) {
  Rig r;
  ASSERT_TRUE(r.master.start_up());
  ASSERT_TRUE(r.master.enable());
  r.master.pass(milliseconds(100));
  r.ticks(20, {500, 500, 500});
  EXPECT_TRUE(r.master.all_in(State::kFault));
  EXPECT_EQ(r.device.torque_permille(), (std::array<std::int16_t, 3>{0, 0, 0}));
  r.master.reset_faults = true;
  EXPECT_TRUE(r.master.enable(20));
  r.ticks(2, {500, 500, 500});
  EXPECT_EQ(r.device.torque_permille(), (std::array<std::int16_t, 3>{500, 500, 500}));
}

TEST(HandDevice, ASecondMasterStartsOnTheSameHand) {
  Rig r(kUpAndDown);
  ASSERT_TRUE(r.master.start_up());
  ASSERT_TRUE(r.master.enable());
  r.master.pass(milliseconds(200));  // the first master is gone
  VirtualMaster second(r.device, r.master.now());
  ASSERT_TRUE(second.start_up());
  second.reset_faults = true;
  EXPECT_TRUE(second.enable(20));
}

TEST(HandDevice, FramesReadLateActInTheOrderAndTimeTheyWereSent) {  // the device's process did not run for five periods
  Rig r;
  ASSERT_TRUE(r.master.start_up());
  ASSERT_TRUE(r.master.enable());
  const Time wake = r.master.now() + milliseconds(5);
  const auto syncs = r.device.bus_stats().syncs;
  for (int k = 0; k < 5; ++k) {
    const Time sent = r.master.now() + milliseconds(k);
    r.device.submit(can::sync_frame(), HandDevice::kFirstClient, sent);
    for (const can::NodeId n : can::profile::kJointNodes) {
      r.device.submit(can::encode(n, can::Rpdo1{15, static_cast<std::int16_t>(100 * (k + 1))}),
                      HandDevice::kFirstClient, sent);
    }
  }
  r.device.advance(wake);
  EXPECT_EQ(r.device.bus_stats().syncs, syncs + 5);
  // The torque of tick 4, which acts at SYNC 5.
  EXPECT_EQ(r.device.torque_permille(), (std::array<std::int16_t, 3>{400, 400, 400}));
  EXPECT_EQ(r.device.drives()[0]->stats().late_rpdos, 0);
}

TEST(HandDevice, PowerOffTakesTorqueAway) {
  Rig r;
  ASSERT_TRUE(r.master.start_up());
  ASSERT_TRUE(r.master.enable());
  r.ticks(5, {500, 500, 500});
  r.device.power_off();
  EXPECT_EQ(r.device.torque_permille(), (std::array<std::int16_t, 3>{0, 0, 0}));
}

TEST(HandDevice, WakesForEveryAnswerAndRestsOtherwise) {
  Rig r;
  ASSERT_TRUE(r.master.start_up({.rpdo_timeout_ms = 0, .heartbeat_timeout_ms = 0, .heartbeat_period_ms = 0}));
  r.master.pass(milliseconds(5));
  EXPECT_EQ(r.device.wake_at(1), kNever);
  r.master.send(can::sdo_read(can::kElbow, can::od::kStatusword));
  r.device.advance(r.master.now());
  EXPECT_NE(r.device.wake_at(1), kNever);
}

}  // namespace
}  // namespace ligature::sim
