#include <gtest/gtest.h>

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

}  // namespace
}  // namespace ligature::host
