// The whole rig in virtual time with drives from the shelf: simulated ODrives and moteus controllers on buses that take
// the time of each bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "host/knot/recognise.hpp"
#include "tests/integration/virtual_rig/shelf_rig.hpp"

namespace ligature {
namespace {

/// Runs the whole script, which must end with the knot tied, without a fault or a missed deadline.
void tie_the_overhand(ShelfRig& rig) {
  ASSERT_EQ(rig.run(23000), std::nullopt);
  EXPECT_EQ(rig.controller.fault(), control::Fault::kNone);
  EXPECT_EQ(rig.cycle.timing().deadline_misses, 0U);
  std::vector<std::array<double, 3>> points;
  for (const auto& p : rig.thread.nodes_W()) points.push_back({p.x(), p.y(), p.z()});
  EXPECT_EQ(knot::recognise(points, false).type, "3_1");
}

class ShelfDrives : public testing::TestWithParam<const char*> {};

TEST_P(ShelfDrives, TieTheOverhandWithEverySampleFresh) {
  ShelfRig rig(GetParam());
  tie_the_overhand(rig);
  std::int64_t stale = 0, pushed = 0;
  for (const auto& r : rig.records) {
    if (r.state == static_cast<int>(control::State::kForce)) stale += r.tpdo_age_ticks[0] + r.tpdo_age_ticks[1];
    pushed += std::ranges::any_of(r.torque_permille[0], [](auto t) { return t != 0; });
  }
  EXPECT_EQ(stale, 0);
  EXPECT_GT(pushed, 1000);
  EXPECT_EQ(rig.trips(), 6) << "start-up tries each watchdog once";
  // Both hands begin in the same period, and not during a trial.
  const auto apart = rig.left.device.mechanics().started_at() - rig.right.device.mechanics().started_at();
  EXPECT_LT(std::chrono::abs(apart), std::chrono::milliseconds(2));
  const auto& bus_stats = rig.left.device.bus_stats();
  std::printf("%s: bus load %.3f, torques until %.0f us after the first request\n", GetParam(),
              rig.left.device.bus_load(), static_cast<double>(bus_stats.worst_rpdo.count()) * 1e-3);
  EXPECT_NEAR(rig.left.device.bus_load(), rig.setup.device.moteus ? 0.83 : 0.86, 0.03);  // docs/drives.md
}

TEST_P(ShelfDrives, AHandThatDiesFreesTheOther) {
  ShelfRig rig(GetParam());
  rig.cut_left_at = 2500;
  ASSERT_EQ(rig.run(2600), std::nullopt);
  EXPECT_EQ(rig.controller.fault(), control::Fault::kBusLost);
  bool pushed_before = false;
  for (const auto& r : rig.records) {
    if (r.tick < 2500) pushed_before |= std::ranges::any_of(r.torque_permille[1], [](auto t) { return t != 0; });
    if (r.tick < 2500) continue;
    EXPECT_EQ(r.fault, 10);
    EXPECT_EQ(r.torque_permille[1], (std::array<std::int16_t, 3>{})) << r.tick;
  }
  EXPECT_TRUE(pushed_before);
  for (const auto& drive : rig.right.device.drives()) EXPECT_EQ(drive->torque_Nm(), 0.0);
}

TEST_P(ShelfDrives, PowerOffTakesTheTorqueAwayAndTheAnswers) {
  ShelfRig rig(GetParam());
  bool had_torque = false;
  rig.each_tick = [&] {
    if (rig.cycle.periods() != 2500) return;
    had_torque = rig.has_torque();
    for (DeviceBus* b : rig.buses()) b->device.power_off();
    EXPECT_FALSE(rig.has_torque());
  };
  ASSERT_EQ(rig.run(2600), std::nullopt);
  EXPECT_TRUE(had_torque);
  EXPECT_FALSE(rig.has_torque());
  EXPECT_NE(rig.controller.fault(), control::Fault::kNone);
}

class ShippedRecord : public testing::TestWithParam<const char*> {};

TEST_P(ShippedRecord, TiesTheOverhandWithSimulatedCiA402Drives) {
  ShelfRig rig(GetParam());
  tie_the_overhand(rig);
  const auto in_force = [](const auto& r) { return r.state == static_cast<int>(control::State::kForce); };
  EXPECT_GT(std::ranges::count_if(rig.records, in_force), 15000);
}

INSTANTIATE_TEST_SUITE_P(Of, ShippedRecord,
                         testing::Values("omni.toml", "cartesian.toml", "inverse3.toml", "epos4.toml",
                                         "generic-cia402.toml"),
                         [](const auto& record) {
                           std::string name = record.param;
                           std::erase_if(name, [](char c) { return c == '-'; });
                           return name.substr(0, name.find('.'));
                         });

INSTANTIATE_TEST_SUITE_P(Records, ShelfDrives, testing::Values("odrive.toml", "moteus.toml"),
                         [](const auto& record) { return std::string(record.param).substr(0, 6); });

}  // namespace
}  // namespace ligature
