// The real-time loop (Cycle) in virtual time, so that all times are exact.
#include <gtest/gtest.h>

#include "tests/unit/firmware/virtual_rig.hpp"

namespace ligature {
namespace {

using namespace std::chrono_literals;
constexpr std::int64_t kRun = 300;

void expect_consecutive(const std::vector<rt::TickRecord>& records) {
  for (std::size_t i = 0; i < records.size(); ++i) {
    ASSERT_EQ(records[i].tick, static_cast<std::int64_t>(i));
    ASSERT_EQ(records[i].scheduled_ns, (static_cast<std::int64_t>(i) + 1) * 1'000'000);
  }
}

std::int64_t flagged(const std::vector<rt::TickRecord>& records, std::int32_t flag) {
  return std::count_if(records.begin(), records.end(), [&](const auto& r) { return (r.flags & flag) != 0; });
}

TEST(Cycle, WakesAtMultiplesOfThePeriodAndRecordsEach) {
  VirtualRig rig;
  rig.cycle.end_after(kRun);
  rig.cycle.run();
  const auto records = rig.records();
  expect_consecutive(records);
  EXPECT_EQ(flagged(records, rt::kPeriodLost | rt::kDeadlineMissed), 0);
  for (std::size_t i = 0; i < rig.clock.woken.size(); ++i) {
    EXPECT_EQ(rig.clock.woken[i], static_cast<std::int64_t>(i + 1) * 1ms);
  }
  EXPECT_EQ(records.back().control_ns, 460'000);
  EXPECT_EQ(rig.cycle.periods(), static_cast<std::int64_t>(records.size()));
}

TEST(Cycle, EveryRecordSaysWhenItsPhasesEnded) {
  VirtualRig rig;
  rig.bus.stalls[20] = 100us;
  rig.cycle.end_after(30);
  rig.cycle.run();
  for (const auto& r : rig.records()) {
    const std::int32_t waited_ns = r.tick == 19 ? 560'000 : 460'000;  // in virtual time only waiting takes time
    EXPECT_EQ(r.sync_ns, 0);
    EXPECT_EQ(r.tpdo_ns, waited_ns);
    EXPECT_EQ(r.law_ns, waited_ns);
    EXPECT_EQ(r.control_ns, waited_ns);
    EXPECT_EQ(r.execution_ns, waited_ns);
  }
}

// The tick at 10 ms ends at 13.7 ms, so periods 11, 12 and 13 are lost.
TEST(Cycle, SkipsAndCountsLostPeriodsAfterAStall) {
  VirtualRig rig;
  rig.bus.stalls[10] = 3240us;
  rig.cycle.end_after(kRun);
  rig.cycle.run();
  const auto records = rig.records();
  expect_consecutive(records);
  EXPECT_EQ(rig.cycle.timing().deadline_misses, 1U);
  EXPECT_EQ(rig.cycle.timing().periods_lost, 3U);
  EXPECT_EQ(flagged(records, rt::kDeadlineMissed), 1);
  EXPECT_EQ(flagged(records, rt::kPeriodLost), 3);
  EXPECT_NE(records[9].flags & rt::kDeadlineMissed, 0);
  for (const std::size_t lost : {10U, 11U, 12U}) EXPECT_NE(records[lost].flags & rt::kPeriodLost, 0) << lost;
  EXPECT_EQ(rig.clock.woken[10], 14ms);  // the next period that has not begun; lost ones are not made up for
  EXPECT_EQ(rig.clock.woken[11], 15ms);
}

TEST(Cycle, SkipsAndCountsPeriodsItSleptThrough) {
  VirtualRig rig;
  rig.clock.late_by = 4200us;  // the first wake-up, due at 1 ms, happens at 5.2 ms
  rig.cycle.end_after(kRun);
  rig.cycle.run();
  const auto records = rig.records();
  expect_consecutive(records);
  EXPECT_EQ(rig.cycle.timing().periods_lost, 4U);
  EXPECT_EQ(rig.cycle.timing().deadline_misses, 0U);
  EXPECT_EQ(records[4].wakeup_latency_ns, 200'000);
  EXPECT_EQ(records[4].flags & rt::kPeriodLost, 0);
  EXPECT_EQ(rig.clock.woken[1], 6ms);
}

TEST(Cycle, FinishingExactlyAtTheDeadlineIsAMiss) {
  VirtualRig rig;
  rig.bus.stalls[10] = 540us;
  rig.cycle.end_after(kRun);
  rig.cycle.run();
  EXPECT_EQ(rig.cycle.timing().deadline_misses, 1U);
  EXPECT_EQ(rig.cycle.timing().periods_lost, 1U);
}

TEST(Cycle, AMissSaysWhetherTheLoopsOwnWorkMadeIt) {
  VirtualRig rig;
  rig.bus.stalls[10] = 700us;  // spent waiting
  rig.bus.works[20] = 250us;   // still in time: 460 us for the bus + 250 us + 285 us until the torques are sent
  rig.bus.works[30] = 700us;
  rig.bus.works[40] = 260us;  // the torques are sent after the next SYNC
  rig.cycle.end_after(kRun);
  rig.cycle.run();
  const auto records = rig.records();
  EXPECT_EQ(records[9].flags, rt::kDeadlineMissed);
  EXPECT_EQ(flagged(records, rt::kOverworked), 2);
  EXPECT_EQ(flagged(records, rt::kDeadlineMissed), 2);
  const auto worked = std::ranges::find_if(records, [](const auto& r) { return (r.flags & rt::kOverworked) != 0; });
  EXPECT_EQ(worked->flags, rt::kDeadlineMissed | rt::kOverworked);
  EXPECT_EQ(records[41].flags, rt::kOverworked);  // two periods were lost before
  EXPECT_EQ(rig.cycle.timing().overworked, 2U);
  EXPECT_EQ(rig.cycle.timing().work.max_ns(), 700'000);
}

TEST(Cycle, HoldsTheLastValuesInLostPeriods) {
  VirtualRig rig;
  rig.bus.stalls[200] = 5ms;
  rig.cycle.end_after(kRun);
  rig.cycle.run();
  const auto records = rig.records();
  for (std::size_t i = 200; i < 205; ++i) {
    EXPECT_EQ(records[i].p_WT_m, records[199].p_WT_m);
    EXPECT_EQ(records[i].torque_permille, records[199].torque_permille);
    EXPECT_EQ(records[i].state, records[199].state);
  }
}

TEST(Cycle, AStallAsLongAsTheWatchdogIsAFaultInTheNextTick) {
  VirtualRig rig;
  rig.bus.stalls[200] = 25ms;
  rig.cycle.end_after(kRun);
  rig.cycle.run();
  EXPECT_EQ(rig.controller.fault(), control::Fault::kOverrun);
  for (const auto& r : rig.records()) {
    if (r.fault == 0 || (r.flags & rt::kPeriodLost) != 0) continue;
    for (const auto& hand : r.torque_permille) EXPECT_EQ(hand, (std::array<std::int16_t, 3>{}));
  }
}

TEST(Cycle, AStallOfTheWholeMachineIsNoSpeedOfTheHand) {  // at 0.38 m/s a sample that is 15 ms late looks like 6 m/s
  VirtualRig rig;
  rig.bus.waist_rad_per_s = 2.0;
  rig.bus.stalls[200] = 15ms;
  rig.cycle.end_after(kRun);
  rig.cycle.run();
  EXPECT_EQ(rig.controller.fault(), control::Fault::kNone);
  for (const auto& r : rig.records()) {
    EXPECT_LT(std::hypot(r.v_WT_m_per_s[0][0], r.v_WT_m_per_s[0][1]), 20.0 * 0.4) << r.tick;
  }
}

TEST(Cycle, AStallLongerThanTheRingCountsWhatItCouldNotKeep) {
  VirtualRig rig;
  rig.bus.stalls[10] = 20s;
  rig.cycle.end_after(kRun);
  rig.cycle.run();
  const auto records = rig.records();
  EXPECT_EQ(static_cast<std::int64_t>(records.size() + rig.outlets->records.dropped()), rig.cycle.periods());
}

TEST(Cycle, TheFlightRecorderGetsEveryPeriodWhateverTelemetryDoes) {
  VirtualRig rig;
  rt::SpscRing<rt::TickRecord> flight(30'000);
  rig.outlets->flight = &flight;
  rig.bus.stalls[10] = 12s;  // longer than telemetry's ring can hold; nothing reads from it
  rig.cycle.end_after(kRun);
  rig.cycle.run();
  EXPECT_GT(rig.outlets->records.dropped(), 0U);
  EXPECT_EQ(flight.dropped(), 0U);
  std::int64_t next = 0;
  for (rt::TickRecord r; flight.pop(r);) EXPECT_EQ(r.tick, next++);
  EXPECT_EQ(next, rig.cycle.periods());
}

TEST(Cycle, TorqueActsExactlyOneSampleAfterItsMeasurement) {
  VirtualRig rig;
  struct Watched {  // records what acts at each SYNC and what was computed in each period
    VirtualBus& bus;
    std::vector<rt::RigCommand> acting, computed;
    void request() noexcept {
      bus.request();
      acting.push_back(bus.acting);
    }
    rt::RigReading read(Nanoseconds d) noexcept { return bus.read(d); }
    [[nodiscard]] rt::BusTime bus_time() const noexcept { return bus.bus_time(); }
    rt::WireTorque write(const rt::RigCommand& c) noexcept {
      computed.push_back(c);
      return bus.write(c);
    }
  } bus{rig.bus, {}, {}};
  for (auto& hand : rig.bus.reading.hand) hand.grip = true;
  Cycle cycle(bus, rig.clock, rig.controller, *rig.exchange, rig.physics, *rig.outlets);
  cycle.end_after(2000);
  cycle.run();
  bool pushed = false;
  for (std::size_t n = 1; n < bus.acting.size(); ++n) {
    for (std::size_t h = 0; h < rt::kHands; ++h) {
      ASSERT_EQ(bus.acting[n].hand[h].torque_Nm, bus.computed[n - 1].hand[h].torque_Nm) << n;
      pushed = pushed || bus.acting[n].hand[h].torque_Nm[1] != 0.0;
    }
  }
  EXPECT_TRUE(pushed) << "no force was ever felt";
}

TEST(Cycle, TheSameRunTwiceIsTheSameToTheLastBit) {
  const auto run = [] {
    VirtualRig rig;
    for (auto& hand : rig.bus.reading.hand) hand.grip = true;
    rig.bus.stalls[100] = 3ms;
    rig.cycle.end_after(1500);
    rig.cycle.run();
    return rig.records();
  };
  const auto first = run(), second = run();
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    ASSERT_EQ(first[i].f_device_N, second[i].f_device_N) << i;
    ASSERT_EQ(first[i].kinetic_J, second[i].kinetic_J) << i;
    ASSERT_EQ(first[i].potential_J, second[i].potential_J) << i;
  }
}

TEST(Cycle, StopsByItsFlagAndTakesCommandsByTheRing) {
  VirtualRig rig(small_scene(), {20, false});
  rig.outlets->commands.push({1, rt::CommandKind::kArm});
  rig.bus.stalls[400] = 0ms;
  rig.cycle.end_after(1000);
  rig.cycle.run();
  EXPECT_TRUE(std::ranges::any_of(
      rig.records(), [](const auto& r) { return r.state == static_cast<std::int8_t>(control::State::kEngage); }));

  VirtualRig stopped;
  stopped.outlets->stop = true;
  stopped.cycle.run();
  EXPECT_LE(stopped.cycle.periods(), 30);
}

TEST(Cycle, PublishesTheShape) {
  VirtualRig rig;
  rig.cycle.end_after(100);
  rig.cycle.run();
  ASSERT_TRUE(rig.outlets->shape.refresh());
  EXPECT_EQ(rig.outlets->shape.front().count, 10);
  EXPECT_NEAR(rig.outlets->shape.front().p_W_m[0][2], 5.5F, 1e-6F);
}

TEST(Cycle, ACommandBesideAResetOfTheThreadTakesNothingFromIt) {
  VirtualRig rig;
  rig.bus.on_sync = [&](std::int64_t sync) {
    if (sync != 1000) return;
    rig.outlets->commands.push({1, rt::CommandKind::kResetThread});
    rig.outlets->commands.push({2, rt::CommandKind::kArm});
  };
  rig.cycle.end_after(1005);
  rig.cycle.run();
  const auto records = rig.records();
  ASSERT_NE(records[999].potential_J, records[0].potential_J);
  EXPECT_EQ(records[1000].potential_J, records[0].potential_J);  // one tick after the start, again
}

}  // namespace
}  // namespace ligature
