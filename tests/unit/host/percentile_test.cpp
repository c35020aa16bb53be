// percentile() compared with its definition, on sorted samples.
#include <gtest/gtest.h>

#include <numeric>
#include <vector>

#include "host/percentile.hpp"
#include "tests/support/random.hpp"

namespace ligature::host {
namespace {

TEST(Percentile, IsExactOnOneToAHundred) {
  std::vector<std::int32_t> samples(100);
  std::iota(samples.rbegin(), samples.rend(), 1);
  EXPECT_EQ(percentile(samples, 50.0), 50);
  EXPECT_EQ(percentile(samples, 99.0), 99);
  EXPECT_EQ(percentile(samples, 100.0), 100);
  EXPECT_EQ(percentile(samples, 0.5), 1);
}

TEST(Percentile, IsTheSmallestSampleThatEnoughOthersDoNotExceed) {
  ligature::test::Random random(2);
  for (const std::size_t count : {1U, 2U, 3U, 10U, 997U}) {
    std::vector<std::int32_t> samples(count);
    for (auto& sample : samples) sample = static_cast<std::int32_t>(random() % 50);  // with equal values
    for (const double percent : {1.0, 50.0, 90.0, 99.0, 99.9, 100.0}) {
      const auto found = percentile(samples, percent);
      const auto below = std::ranges::count_if(samples, [&](auto s) { return s < found; });
      const auto up_to = std::ranges::count_if(samples, [&](auto s) { return s <= found; });
      const double needed = percent / 100.0 * static_cast<double>(count) - 1e-9;
      EXPECT_GE(static_cast<double>(up_to), needed);
      EXPECT_LT(static_cast<double>(below), needed);
    }
  }
}

TEST(Percentile, OfNothingIsZero) { EXPECT_EQ(percentile({}, 50.0), 0); }

}  // namespace
}  // namespace ligature::host
