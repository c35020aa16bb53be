// The thread's physics beside the loop, in virtual time. When the physics needs too long, less simulated time passes,
// but the loop never waits.
#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "tests/support/random.hpp"
#include "tests/unit/firmware/virtual_rig.hpp"

namespace ligature {
namespace {

using namespace std::chrono_literals;

scene::Scene eight_substeps() {
  scene::Scene s = small_scene();
  s.time.substeps = 8;
  return s;
}

scene::Scene long_rod() {  // 2000 nodes: more work than any tick has time for
  scene::Scene s = small_scene();
  s.suture.model = scene::Model::kRod;
  s.suture.radius_m = 1e-3;
  s.suture.nodes = 2000;
  return s;
}

struct HeldRig : VirtualRig {
  explicit HeldRig(const scene::Scene& scene = eight_substeps()) : VirtualRig(scene) {
    for (auto& hand : bus.reading.hand) hand.grip = true;
    bus.on_sync = [this](std::int64_t) { synced_at.push_back(clock.time); };
  }
  std::vector<rt::TickRecord> run(std::int64_t ticks) {
    cycle.end_after(ticks);
    cycle.run();
    return records();
  }
  std::vector<Nanoseconds> synced_at;
};

/// The loop is unaffected by the physics: SYNC in every period, control law and torques right after the samples, no
/// period lost.
void expect_loop_in_time(const HeldRig& rig, const std::vector<rt::TickRecord>& records) {
  for (std::size_t i = 0; i < rig.synced_at.size(); ++i)
    ASSERT_EQ(rig.synced_at[i], static_cast<std::int64_t>(i + 1) * 1ms) << i;
  for (const auto& r : records) {
    ASSERT_EQ(r.flags & (rt::kPeriodLost | rt::kDeadlineMissed | rt::kOverworked), 0) << r.tick;
    ASSERT_EQ(r.control_ns, 460'000) << r.tick;
    ASSERT_EQ(r.execution_ns, 460'000) << r.tick;
  }
}

/// Shortest time that the physics has in one of 1000 ticks: from when it gets the tools' positions (a time `law` after
/// the encoder samples) until its deadline in the next period.
Nanoseconds usable(Nanoseconds law) {
  rt::ThreadDeadline deadline(platform::cia402_time());
  Nanoseconds least = 1s;
  test::Random random(1);
  for (int k = 0; k < 1000; ++k) {  // arrival times of samples differ by a few bit times
    const Nanoseconds sampled = 420us + std::chrono::microseconds(random() % 20);
    deadline.note(sampled);
    least = std::min(least, deadline.before(1ms) - sampled - law);
  }
  return least;
}

TEST(Thread, HasMostOfAPeriod) {
  EXPECT_GE(usable(50us), 850us);
  rt::ThreadDeadline deadline(platform::cia402_time());
  EXPECT_EQ(deadline.before(1ms), 1ms + 435us);
  deadline.note(379us);  // one microsecond earlier than the bus can carry them
  EXPECT_EQ(deadline.before(1ms), 1ms + 435us);
  deadline.note(380us);
  EXPECT_EQ(deadline.before(1ms), 1ms + 355us);
  deadline.note(0us);
  EXPECT_EQ(deadline.before(1ms), 1ms + 355us + rt::ThreadDeadline::kForgets);
  for (int k = 0; k < 10'000; ++k) deadline.note(5ms);
  EXPECT_EQ(deadline.before(1ms), 1ms + 435us);
}

TEST(Thread, AThreadThatFitsIsNeverOlderThanOnePeriod) {
  HeldRig rig;
  // Virtual time between two queries of the clock; eight substeps, start and end take 440 us.
  rig.physics.per_question = 40us;
  const auto records = rig.run(1500);
  expect_loop_in_time(rig, records);
  for (const auto& r : records) {
    ASSERT_EQ(r.grasp_age_ticks, 1) << r.tick;
    ASSERT_EQ(r.flags & (rt::kThreadLate | rt::kThreadCut), 0) << r.tick;
    ASSERT_EQ(r.time_lost, 0.0F) << r.tick;
  }
  EXPECT_GE(records[1000].grasped_node[0], 0);
  EXPECT_EQ(records[1000].thread_start_ns, 500'000);
  EXPECT_EQ(records[1000].thread_end, 0);
  EXPECT_EQ(rig.controller.fault(), control::Fault::kNone);
}

TEST(Thread, WhatItCostsChangesNothingAsLongAsItFits) {
  const auto forces = [](Nanoseconds cost) {
    HeldRig rig;
    rig.physics.per_question = cost;
    std::vector<std::array<rt::Triple, 2>> felt;
    for (const auto& r : rig.run(1500)) felt.push_back(r.f_device_N), felt.push_back(r.f_world_N);
    return felt;
  };
  const auto at_once = forces(0us);
  EXPECT_EQ(at_once, forces(40us));
  EXPECT_NE(at_once, forces(150us)) << "what does not fit must";
}

TEST(Thread, TheClockEndsATickThatDoesNotFit) {
  HeldRig rig;
  rig.physics.per_question = 150us;  // virtual time between two queries: only three or four of eight substeps fit
  const auto records = rig.run(1500);
  expect_loop_in_time(rig, records);
  for (const auto& r : records) {
    if (r.tick < 2 || &r == &records.back()) continue;  // the first ticks have no estimate of a piece's duration
    ASSERT_EQ(r.grasp_age_ticks, 1) << r.tick;
    ASSERT_EQ(r.flags & (rt::kThreadLate | rt::kThreadCut), rt::kThreadCut) << r.tick;
    ASSERT_EQ(r.thread_end, static_cast<int>(physics::TickEnd::kClock)) << r.tick;
    ASSERT_GT(r.time_lost, 0.4F) << r.tick;
    ASSERT_LT(r.time_lost, 0.9F) << r.tick;
    ASSERT_LT(r.thread_done_ns, 1'380'000) << r.tick;
  }
  EXPECT_GE(rig.cycle.timing().thread_cut, 1490U);
  EXPECT_NEAR(rig.cycle.timing().thread_lost_ticks / 1500.0, records[1000].time_lost, 0.1);
  EXPECT_EQ(rig.controller.fault(), control::Fault::kNone);
}

TEST(Thread, TwoThousandNodesUnderForceHoldUpNothingAndTheLossIsTold) {
  HeldRig rig(long_rod());
  rig.physics.per_question = 50us;
  const auto records = rig.run(1200);
  expect_loop_in_time(rig, records);
  std::int64_t cut = 0, held = 0;
  for (const auto& r : records) {
    if (r.tick < 2 || &r == &records.back()) continue;
    ASSERT_EQ(r.grasp_age_ticks, 1) << r.tick;
    ASSERT_EQ(r.flags & rt::kThreadLate, 0) << r.tick;
    ASSERT_EQ((r.flags & rt::kThreadCut) != 0, r.time_lost > 0.0F) << r.tick;
    cut += (r.flags & rt::kThreadCut) != 0;
    held += r.grasped_node[0] >= 0 && r.state == static_cast<int>(control::State::kForce);
  }
  EXPECT_GT(cut, 1000);
  EXPECT_GT(held, 100);
  EXPECT_EQ(rig.controller.fault(), control::Fault::kNone);
}

TEST(Thread, ATickOfTheLoopThatIsLateTakesNothingFromTheThread) {
  HeldRig rig;
  rig.physics.per_question = 40us;
  rig.bus.stalls[100] = 900us;  // the loop's tools arrive after the thread's deadline, its next samples a period later
  rig.bus.stalls[200] = 3240us;
  const auto records = rig.run(300);
  EXPECT_EQ(rig.cycle.timing().periods_lost, 4U);
  EXPECT_EQ(rig.cycle.timing().thread_cut, 0U);
  for (const auto& r : records) ASSERT_EQ(r.time_lost, 0.0F) << r.tick;
}

TEST(Thread, AnEndlessTickHoldsUpNothingAndIsAFaultAfterTheWatchdogsTime) {
  HeldRig rig;  // force is on at tick 1200
  rig.physics.stalls = [](std::int64_t n) { return n == 1200 ? Nanoseconds(60ms) : Nanoseconds(0); };
  const auto records = rig.run(1500);
  expect_loop_in_time(rig, records);
  std::int64_t late = 0;
  for (const auto& r : records) late += (r.flags & rt::kThreadLate) != 0;
  EXPECT_EQ(late, 59);  // the physics is busy for 60 ms and gets new tool positions in the 60th period
  for (std::int64_t k = 1201; k < 1219; ++k) {
    ASSERT_EQ(records[static_cast<std::size_t>(k)].grasp_age_ticks, k - 1199);
    ASSERT_EQ(records[static_cast<std::size_t>(k)].fault, 0) << "the law goes on with the grasp that it has";
  }
  EXPECT_EQ(records[1220].fault, static_cast<int>(control::Fault::kThreadLate));
  for (const auto& hand : records[1220].torque_permille) EXPECT_EQ(hand, (std::array<std::int16_t, 3>{}));
  EXPECT_EQ(records[1270].grasp_age_ticks, 1) << "what was missed is not made up for";
}

TEST(Thread, AResetAndAnotherSceneComeInTheirOrderWithTheTools) {
  for (const auto cost : {Nanoseconds(0us), Nanoseconds(40us)}) {
    HeldRig rig;
    control::PlantHandover plants;
    rig.cycle.listen(plants);
    rig.physics.per_question = cost;
    rig.bus.on_sync = [&](std::int64_t sync) {
      if (sync == 1000) rig.outlets->commands.push({1, rt::CommandKind::kResetThread});
    };
    const auto records = rig.run(1010);
    EXPECT_NE(records[999].potential_J, records[0].potential_J);
    EXPECT_EQ(records[1000].potential_J, records[0].potential_J);
  }
}

/// A rig that is sent a scene and ARM while the scene is on its way, then perhaps another command. @return the records
std::vector<rt::TickRecord> armed_during_a_change(std::optional<rt::CommandKind> then) {
  VirtualRig rig(small_scene(), {20, false});
  control::PlantHandover plants;
  rig.cycle.listen(plants);
  scene::Scene other = small_scene();
  other.hands.workspace_scale = 10.0;
  control::Plant plant{std::get<physics::Simulation>(physics::Simulation::make(other)), other.hands, false, false};
  rig.physics.stalls = [](std::int64_t n) { return n == 200 ? Nanoseconds(10ms) : Nanoseconds(0); };
  rig.bus.on_sync = [&](std::int64_t sync) {
    if (sync == 200) plants.offer(&plant);
    if (sync == 203) rig.outlets->commands.push({1, rt::CommandKind::kArm});
    if (sync == 204 && then) rig.outlets->commands.push({2, *then});
  };
  rig.cycle.end_after(300);
  rig.cycle.run();
  EXPECT_TRUE(plant.taken);
  EXPECT_EQ(plants.collect(), &plant);
  return rig.records();
}

TEST(Thread, ArmingWaitsForASceneThatIsUnderWay) {
  const auto records = armed_during_a_change({});
  EXPECT_FALSE(records[205].armed) << "the scene is still on its way";
  EXPECT_TRUE(records[215].armed);
}

TEST(Thread, DisarmAndStopEndAnArmingThatWaits) {
  for (const auto kind : {rt::CommandKind::kDisarm, rt::CommandKind::kStop}) {
    const auto records = armed_during_a_change(kind);
    EXPECT_FALSE(records[215].armed) << static_cast<int>(kind);
    EXPECT_FALSE(records[299].armed) << static_cast<int>(kind);
  }
}

}  // namespace
}  // namespace ligature
