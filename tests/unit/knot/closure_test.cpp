#include "host/knot/closure.hpp"

#include <gtest/gtest.h>

namespace ligature::knot {
namespace {

TEST(Closure, JoinsFarOutsideWhateverTheDirections) {
  const std::vector<Point> thread{{-1, 0, 0}, {0, 1, 0}, {1, 0, 0}};
  for (const Point& first : {Point(-1, 0, 0), Point(0, 0, 1), Point(1, 0, 0)}) {
    const auto way = way_home(thread, first, Point(1, 0, 0));
    ASSERT_GE(way.size(), 2u);
    for (std::size_t k = 0; k + 1 < way.size(); ++k) {
      EXPECT_GT((0.5 * (way[k] + way[k + 1])).norm(), 10.0);  // the closing chord stays away from the thread
      EXPECT_TRUE(way[k].allFinite());
    }
  }
}

TEST(Closure, SpreadDirectionsAreUnitVectorsThatBalance) {
  Point sum = Point::Zero();
  for (int k = 0; k < 50; ++k) {
    EXPECT_NEAR(spread_direction(k, 50).norm(), 1.0, 1e-12);
    sum += spread_direction(k, 50);
  }
  EXPECT_LT(sum.norm(), 1.0);
}

TEST(Closure, OutwardIsAUnitVectorEvenFromTheCentre) {
  const std::vector<Point> thread{{-1, 0, 0}, {1, 0, 0}};
  EXPECT_EQ(outward(thread, Point(1, 0, 0)), Point(1, 0, 0));
  EXPECT_EQ(outward(thread, Point(0, 0, 0)), Point(0, 0, 1));
}

}  // namespace
}  // namespace ligature::knot
