// The whole rig in virtual time: results that depend on timing on a real machine are exact here.
#include <gtest/gtest.h>

#include <cmath>

#include "host/knot/recognise.hpp"
#include "tests/integration/virtual_rig/scenes.hpp"
#include "tests/integration/virtual_rig/simulated_rig.hpp"

namespace ligature {
namespace {

scene::GripperScript overhand() {
  return std::get<scene::GripperScript>(scene::load_gripper_script(kScenes + "operators/overhand.csv"));
}

double magnitude(const rt::Triple& f) { return std::sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]); }

TEST(VirtualRig, TiesTheOverhandOverCanWithEverySampleFresh) {
  SimulatedRig rig(paper(), overhand());
  ASSERT_EQ(rig.run(23000), std::nullopt);
  EXPECT_EQ(rig.controller.fault(), control::Fault::kNone);
  EXPECT_EQ(rig.cycle.timing().deadline_misses, 0U);
  EXPECT_EQ(rig.cycle.timing().periods_lost, 0U);
  double peak_N = 0.0;
  std::int64_t stale = 0;
  for (std::size_t i = 0; i < rig.records.size(); ++i) {
    const auto& r = rig.records[i];
    ASSERT_EQ(r.tick, static_cast<std::int64_t>(i));
    stale += r.tpdo_age_ticks[0] != 0 || r.tpdo_age_ticks[1] != 0;
    peak_N = std::max({peak_N, magnitude(r.f_device_N[0]), magnitude(r.f_device_N[1])});
  }
  EXPECT_EQ(stale, 0);
  EXPECT_GT(peak_N, 0.01);
  EXPECT_LE(peak_N, 3.3);
  std::vector<std::array<double, 3>> points;
  for (const auto& p : rig.thread.nodes_W()) points.push_back({p.x(), p.y(), p.z()});
  EXPECT_EQ(knot::recognise(points, false).type, "3_1");
}

TEST(VirtualRig, TheSameRunTwiceIsTheSameToTheLastBit) {
  const auto run = [] {
    SimulatedRig rig(paper(), overhand());
    EXPECT_EQ(rig.run(3000), std::nullopt);
    return rig.records;
  };
  const auto first = run(), second = run();
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    ASSERT_EQ(first[i].torque_permille, second[i].torque_permille) << i;
    ASSERT_EQ(first[i].p_WT_m, second[i].p_WT_m) << i;
    ASSERT_EQ(first[i].potential_J, second[i].potential_J) << i;
  }
}

TEST(VirtualRig, ACleanEndIsNoFaultToTheDrives) {
  SimulatedRig rig(paper(), overhand());
  ASSERT_EQ(rig.run(1500), std::nullopt);
  for (const auto& drives : rig.drives) drives->release(rig.wait);
  rig.time += std::chrono::seconds(2);
  for (DeviceBus* bus : {&rig.left, &rig.right}) {
    bus->device.advance(rig.time);
    for (std::size_t i = 0; i < 3; ++i) {
      const sim::DriveNode& drive = bus->device.cia402(i);
      EXPECT_EQ(drive.nmt_state(), can::NmtState::kPreOperational);
      EXPECT_EQ(drive.state(), can::cia402::State::kSwitchOnDisabled);
      EXPECT_EQ(drive.stats().watchdog_trips, 0);
      EXPECT_EQ(drive.torque_permille(), 0);
    }
  }
}

TEST(VirtualRig, AHandThatDiesFreesTheOtherInTheSameTick) {
  SimulatedRig rig(paper(), overhand());
  rig.cut_left_at = 1500;
  ASSERT_EQ(rig.run(1600), std::nullopt);
  EXPECT_EQ(rig.controller.fault(), control::Fault::kBusLost);
  bool pushed_before = false;
  for (const auto& r : rig.records) {
    const bool pushes = std::ranges::any_of(r.torque_permille[1], [](auto t) { return t != 0; });
    if (r.tick < 1500) pushed_before = pushed_before || pushes;
    if (r.tick >= 1500) {
      EXPECT_EQ(r.fault, 10) << r.tick;
      EXPECT_FALSE(pushes) << r.tick;
    }
  }
  EXPECT_TRUE(pushed_before);
  EXPECT_EQ(rig.right.device.torque_permille(), (std::array<std::int16_t, 3>{}));
}

TEST(VirtualRig, ARunThatEndsInForceLeavesEveryDriveOff) {
  SimulatedRig rig(paper(), overhand());
  ASSERT_EQ(rig.run(1500), std::nullopt);
  for (const DeviceBus* bus : {&rig.left, &rig.right}) {
    EXPECT_EQ(bus->device.torque_permille(), (std::array<std::int16_t, 3>{}));
    for (const auto& drive : bus->device.drives()) EXPECT_FALSE(drive->is_enabled());
  }
}

}  // namespace
}  // namespace ligature
