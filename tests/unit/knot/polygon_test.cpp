#include "host/knot/polygon.hpp"

#include <gtest/gtest.h>

#include "host/knot/alexander.hpp"
#include "host/knot/projection.hpp"
#include "tests/support/random.hpp"
#include "tests/unit/knot/shapes.hpp"

namespace ligature::knot {
namespace {

std::vector<Point> points_of(const shapes::Polyline& line) {
  std::vector<Point> p;
  for (const auto& v : line) p.emplace_back(v[0], v[1], v[2]);
  jitter(p);
  return p;
}

TEST(Polygon, AnUnknotShrinksToATriangle) {
  Polygon circle(points_of(shapes::torus_knot(1, 80)));
  circle.cut_corners();
  EXPECT_EQ(circle.corners().size(), 3u);
}

TEST(Polygon, ATrefoilNeverShrinksBelowItsSixSticks) {
  test::Random random(1);
  for (int k = 0; k < 50; ++k) {
    Polygon trefoil(points_of(shapes::posed(shapes::trefoil(60), random, 0.03)));
    trefoil.cut_corners();
    EXPECT_GE(trefoil.corners().size(), 6u);
    EXPECT_LE(trefoil.corners().size(), 15u);
  }
}

TEST(Polygon, ShakingKeepsTheKnot) {
  test::Random random(4);
  Draw draw(random());
  for (int k = 0; k < 50; ++k) {
    Polygon knot(points_of(shapes::posed(shapes::figure_eight(60), random, 0.02)));
    knot.cut_corners();
    for (int i = 0; i < 20; ++i) {
      knot.shake(draw);
      const auto d = simplest_view(knot.corners(), 12);
      ASSERT_TRUE(d);
      ASSERT_EQ(alexander(*d), (std::vector<int>{1, -3, 1}));
    }
  }
}

}  // namespace
}  // namespace ligature::knot
