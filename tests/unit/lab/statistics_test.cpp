#include "host/lab/statistics.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace ligature::lab {
namespace {

TEST(Spread, IsNearestRank) {
  std::vector<double> v(200);
  std::iota(v.rbegin(), v.rend(), 1.0);
  const auto s = spread_of(v);
  EXPECT_EQ(s.median, 100.0);
  EXPECT_EQ(s.p99, 198.0);
  EXPECT_EQ(s.max, 200.0);
  EXPECT_EQ(spread_of({7.0}).p99, 7.0);
  EXPECT_EQ(spread_of({}).max, 0.0);
}

TEST(MaxMean, OfNothingIsZero) {
  MaxMean m;
  EXPECT_EQ(m.mean(), 0.0);
  m.add(1.0);
  m.add(3.0);
  EXPECT_EQ(m.mean(), 2.0);
  EXPECT_EQ(m.max, 3.0);
}

}  // namespace
}  // namespace ligature::lab
