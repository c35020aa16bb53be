// Compares the loop's timing statistics (maximum, quantiles), which need constant memory, with the same values computed
// from all samples.
#include "firmware/rt/cycle_timing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/random.hpp"

namespace ligature::rt {
namespace {

TEST(DurationStatistics, IsZeroWhenEmpty) {
  const DurationStatistics s;
  EXPECT_EQ(s.quantile_ns(0.5), 0);
  EXPECT_EQ(s.max_ns(), 0);
}

TEST(DurationStatistics, MatchesTheSampleItself) {
  DurationStatistics s;
  test::Random random(7);
  const auto duration = [&] { return 5e4 * std::exp(random.normal()); };
  std::vector<std::int64_t> all;
  for (int i = 0; i < 20000; ++i) {
    all.push_back(static_cast<std::int64_t>(duration()));
    s.add(all.back());
  }
  std::sort(all.begin(), all.end());
  EXPECT_EQ(s.count(), all.size());
  EXPECT_EQ(s.max_ns(), all.back());
  for (const double q : {0.01, 0.5, 0.99, 0.999}) {  // never too low, and too high by at most one bin (1/32)
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
