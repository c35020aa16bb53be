#include "host/knot/diagram.hpp"

#include <gtest/gtest.h>

#include "host/knot/alexander.hpp"
#include "host/knot/jones.hpp"
#include "host/knot/projection.hpp"
#include "tests/support/random.hpp"
#include "tests/unit/knot/shapes.hpp"

namespace ligature::knot {
namespace {

std::vector<Point> points(const shapes::Polyline& line) {
  std::vector<Point> p;
  for (const auto& v : line) p.emplace_back(v[0], v[1], v[2]);
  return p;
}

TEST(Projection, TheStandardTrefoilHasWritheThree) {
  const auto seen = project(points(shapes::trefoil(50)), Point(0.013, -0.021, 1).normalized());
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->crossings(), 3u);
  EXPECT_EQ(writhe(*seen), 3);
  const auto behind = project(points(shapes::trefoil(50)), -Point(0.013, -0.021, 1).normalized());
  EXPECT_EQ(writhe(*behind), 3);  // the writhe is the same from behind
}

TEST(Projection, RefusesAViewAlongAnEdge) {
  const std::vector<Point> square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  EXPECT_FALSE(project(square, Point(1, 0, 0)));
  EXPECT_TRUE(project(square, Point(0, 0, 1)));
}

TEST(Reduce, UndoesAKink) {
  Diagram d{{{0, true}, {0, false}}, {1}};
  reduce(d);
  EXPECT_EQ(d.crossings(), 0u);
}

TEST(Reduce, UndoesAClaspOfOppositeSignsOnly) {
  Diagram loose{{{0, true}, {1, true}, {1, false}, {0, false}}, {1, -1}};
  reduce(loose);
  EXPECT_EQ(loose.crossings(), 0u);
}

TEST(Invariants, AreTheSameFromEveryDirection) {
  test::Random random(1);
  for (int k = 0; k < 40; ++k) {
    const auto line = points(shapes::posed(shapes::figure_eight(40), random, 0.05));
    const auto d = project(line, Point::UnitZ());
    ASSERT_TRUE(d);
    if (d->crossings() > 24) continue;
    EXPECT_EQ(alexander(*d), (std::vector<int>{1, -3, 1}));
    EXPECT_EQ(jones(*d), (Laurent{-2, {1, -1, 1, -1, 1}}));
  }
}

TEST(Invariants, OfTheUnknotAreOne) {
  EXPECT_EQ(alexander({}), std::vector<int>{1});
  EXPECT_EQ(jones({}), (Laurent{0, {1}}));
  const Diagram kink{{{0, true}, {0, false}}, {1}};
  EXPECT_EQ(alexander(kink), std::vector<int>{1});
  EXPECT_EQ(jones(kink), (Laurent{0, {1}}));
}

}  // namespace
}  // namespace ligature::knot
