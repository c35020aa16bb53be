// Statistics in constant memory against the same numbers computed from all samples.
#include "firmware/rt/cycle_timing.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace ligature::rt {
namespace {

TEST(DurationStatistics, IsZeroWhenEmpty) {
  const DurationStatistics s;
  EXPECT_EQ(s.quantile_ns(0.5), 0);
  EXPECT_EQ(s.deviation_ns(), 0.0);
}

TEST(DurationStatistics, MatchesTheSampleItself) {
  DurationStatistics s;
  std::mt19937 random(7);
  std::lognormal_distribution<double> duration(std::log(5e4), 1.0);
  std::vector<std::int64_t> all;
  double sum = 0.0;
  for (int i = 0; i < 20000; ++i) {
    all.push_back(static_cast<std::int64_t>(duration(random)));
    sum += static_cast<double>(all.back());
    s.add(all.back());
  }
  std::sort(all.begin(), all.end());
  const double mean = sum / static_cast<double>(all.size());
  double squares = 0.0;
  for (const auto v : all) squares += std::pow(static_cast<double>(v) - mean, 2);
  EXPECT_EQ(s.min_ns(), all.front());
  EXPECT_EQ(s.max_ns(), all.back());
  EXPECT_NEAR(s.mean_ns(), mean, 1e-9 * mean);
  EXPECT_NEAR(s.deviation_ns(), std::sqrt(squares / static_cast<double>(all.size() - 1)), 1e-6 * mean);
  for (const double q : {0.01, 0.5, 0.99, 0.999}) {  // never too low, at most one bin (1/32) too high
    const auto exact = all[static_cast<std::size_t>(std::ceil(q * static_cast<double>(all.size()))) - 1];
    EXPECT_GE(s.quantile_ns(q), exact);
    EXPECT_LE(static_cast<double>(s.quantile_ns(q)), static_cast<double>(exact) * (1.0 + 1.0 / 32.0) + 1.0);
  }
}

TEST(DurationStatistics, HoldsTheLargestDuration) {
  DurationStatistics s;
  s.add(std::int64_t{1} << 62);
  EXPECT_EQ(s.quantile_ns(1.0), std::int64_t{1} << 62);
}

}  // namespace
}  // namespace ligature::rt
