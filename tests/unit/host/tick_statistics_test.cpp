#include <gtest/gtest.h>

#include "firmware/rt/bus_time.hpp"
#include "host/tick_statistics.hpp"
#include "synthetic_log.hpp"

namespace ligature::host {
namespace {

using ligature_msg::tick_t;

TEST(TickStatistics, ALostPeriodIsNoTimingSample) {
  TickStatistics statistics;
  for (int i = 0; i < 4; ++i) {
    auto tick = test::tick_of(i);
    tick.execution_ns = 100 * (i + 1);
    if (i == 3) tick.flags = tick_t::FLAG_PERIOD_LOST;
    statistics.add(tick);
  }
  EXPECT_EQ(statistics.executed(), 3);
  EXPECT_EQ(statistics.periods_lost(), 1);
  EXPECT_EQ(statistics.execution().max_ns, 300);
  EXPECT_EQ(statistics.execution().p50_ns, 200);
}

TEST(TickStatistics, PercentilesAreThoseTheyAreCalled) {
  TickStatistics statistics;
  for (int i = 1; i <= 1000; ++i) {
    auto tick = test::tick_of(i);
    tick.wakeup_latency_ns = 1001 - i;
    tick.control_ns = 10'000 + i;
    tick.execution_ns = 20'000 + i;
    statistics.add(tick);
  }
  const auto are = [](const Percentiles& p, std::int32_t base) {
    return p.p50_ns == base + 500 && p.p99_ns == base + 990 && p.max_ns == base + 1000;
  };
  EXPECT_TRUE(are(statistics.wakeup(), 0));
  EXPECT_TRUE(are(statistics.control(), 10'000));
  EXPECT_TRUE(are(statistics.execution(), 20'000));
}

TEST(TickStatistics, MeanForceIsOverTheTicksWithAGrasp) {
  TickStatistics statistics;
  for (int i = 0; i < 10; ++i) {
    auto tick = test::tick_of(i);
    tick.f_device_N[1][0] = 0.6 * i;
    tick.f_device_N[1][2] = -0.8 * i;
    if (i >= 6) tick.grasped_node[1] = 12;
    if (i == 9) tick.flags = int{tick_t::FLAG_RIGHT_LIMITED} | int{tick_t::FLAG_DEADLINE_MISSED};
    statistics.add(tick);
  }
  const auto& right = statistics.hands()[1];
  EXPECT_DOUBLE_EQ(right.peak_N, 9.0);
  EXPECT_EQ(right.peak_tick, 9);
  EXPECT_DOUBLE_EQ(right.mean_N(), (6 + 7 + 8 + 9) / 4.0);
  EXPECT_EQ(right.grasp_ticks, 4);
  EXPECT_EQ(right.limited_ticks, 1);
  EXPECT_EQ(statistics.deadline_misses(), 1);
  EXPECT_EQ(statistics.hands()[0].mean_N(), 0.0);
}

TEST(TickStatistics, AFaultCountsOnceUntilItIsLeft) {
  TickStatistics statistics;
  const std::vector<std::int16_t> faults{0, 4, 4, 0, 4, 5, 5};
  for (std::size_t i = 0; i < faults.size(); ++i) {
    auto tick = test::tick_of(static_cast<std::int64_t>(i));
    tick.fault = faults[i];
    statistics.add(tick);
  }
  ASSERT_EQ(statistics.faults().size(), 3U);
  EXPECT_EQ(statistics.faults()[0].tick, 1);
  EXPECT_EQ(statistics.faults()[2].fault, 5);
}

/// A tick whose SYNC was sent at 30 us, whose encoder samples were complete at joints_us, and which ended at
/// execution_us after its start.
tick_t period_of(int number, std::int32_t wakeup_us, std::int32_t joints_us, std::int32_t execution_us) {
  auto tick = test::tick_of(number);
  tick.scheduled_ns = std::int64_t{number} * 1'000'000;
  tick.wakeup_latency_ns = wakeup_us * 1000;
  tick.sync_ns = 30'000;
  tick.tpdo_ns = joints_us * 1000;
  tick.execution_ns = execution_us * 1000;
  return tick;
}

TEST(ThreadTime, IsFromTheToolsToTheNextJointsWithoutTheSync) {
  TickStatistics statistics;
  statistics.add(period_of(1, 10, 450, 500));
  EXPECT_FALSE(statistics.thread_time().known());
  // The physics has the time from the end of tick 1 (10 + 500 us after its period began) to the samples of tick 2
  // (1000 + 20 + 400 us), less the margin of 25 us and 30 us for sending SYNC.
  statistics.add(period_of(2, 20, 400, 480));
  // These samples arrive only at 600 us, but the physics must be ready for the earliest recent arrival, 400.02 us. The
  // time left is 1000 + 0 + 400.02 (arrival) - 25 (margin) - 30 (SYNC) - (20 + 480) (end of tick 2).
  statistics.add(period_of(3, 0, 600, 700));
  EXPECT_EQ(statistics.thread_time().at_least_ns(50), 855'000);
  EXPECT_EQ(statistics.thread_time().at_least_ns(100), 845'020);
  statistics.add(period_of(4, 5, 420, 500));  // 1000 + 5 + 400.04 - 25 - 30 - (0 + 700), as above
  EXPECT_EQ(statistics.thread_time().at_least_ns(50), 845'020);
  EXPECT_EQ(statistics.thread_time().at_least_ns(100), 650'040);
}

/// A late message of an earlier period can come right after the wake-up. It says nothing about the next samples.
TEST(ThreadTime, IsNotLoweredByAMessageEarlierThanTheBusCanCarry) {
  TickStatistics statistics;
  statistics.start_session(380'000);
  statistics.add(period_of(1, 0, 420, 500));
  statistics.add(period_of(2, 0, 379, 500));
  EXPECT_EQ(statistics.thread_time().at_least_ns(100), 1'000'000 + 420'020 - 25'000 - 30'000 - 500'000);
  statistics.add(period_of(3, 0, 380, 500));
  EXPECT_EQ(statistics.thread_time().at_least_ns(100), 1'000'000 + 380'000 - 25'000 - 30'000 - 500'000);
}

/// Drives with longer frames than Ligature's own leave the physics more time before their samples.
TEST(ThreadTime, IsThatOfTheDrivesOfTheRecording) {
  TickStatistics statistics;
  statistics.add(period_of(1, 0, 780, 850));
  statistics.add(period_of(2, 0, 780, 850));
  EXPECT_EQ(statistics.thread_time().at_least_ns(100), 1'000'000 + 780'000 - 25'000 - 30'000 - 850'000);
}

TEST(ThreadTime, IsToldOnlyByPeriodsThatFollowEachOther) {
  const auto known = [](auto change) {
    TickStatistics statistics;
    auto first = period_of(1, 0, 400, 500), second = period_of(2, 0, 400, 500);
    change(statistics, first, second);
    statistics.add(second);
    return statistics.thread_time().known();
  };
  EXPECT_TRUE(known([](auto& all, auto& first, auto&) { all.add(first); }));
  EXPECT_FALSE(known([](auto& all, auto& first, auto& second) { second.tick = 3, all.add(first); }));
  EXPECT_FALSE(known([](auto& all, auto& first, auto&) { all.add(first), all.start_session(); }));
  EXPECT_FALSE(
      known([](auto& all, auto& first, auto&) { first.flags = tick_t::FLAG_DEADLINE_MISSED, all.add(first); }));
  EXPECT_FALSE(known([](auto& all, auto& first, auto&) { first.flags = tick_t::FLAG_PERIOD_LOST, all.add(first); }));
  EXPECT_FALSE(
      known([](auto& all, auto& first, auto& second) { all.add(first), second.flags = tick_t::FLAG_PERIOD_LOST; }));
}

TEST(ThreadTime, HasTheLoopsOwnFigures) {
  EXPECT_EQ(ThreadTime::kMargin_ns, rt::ThreadDeadline::kMargin.count());
  EXPECT_EQ(ThreadTime::kForgets_ns, rt::ThreadDeadline::kForgets.count());
}

}  // namespace
}  // namespace ligature::host
