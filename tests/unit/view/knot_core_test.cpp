#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "host/view/knot_core.hpp"
#include "tests/unit/host/synthetic_log.hpp"

namespace ligature::host::view {
namespace {

TEST(KnotCore, IsAPieceThatStillHoldsTheKnot) {
  const auto points = test::overhand_points(160);
  const auto whole = knot::recognise(points, false);
  ASSERT_EQ(whole.type, "3_1");
  const KnotCore core = find_core(points, whole);
  ASSERT_LT(core.first, core.last);
  EXPECT_LT(core.last - core.first, points.size() - 20);  // without the long ends
  const std::span piece(points.data() + core.first, core.last - core.first + 1);
  EXPECT_EQ(knot::recognise(piece, false).type, "3_1");
}

TEST(KnotCore, IsNowhereInAStraightThread) {
  const auto points = test::straight_points(60);
  const KnotCore core = find_core(points, knot::recognise(points, false));
  EXPECT_EQ(core.last, 0U);
}

using Points = std::vector<std::array<double, 3>>;

/// Two overhands in a row; the second is mirrored, or not.
Points two_overhands(bool is_mirrored) {
  Points points = test::overhand_points(160);
  for (const auto& [x, y, z] : test::overhand_points(160))
    points.push_back({60.0 - x, -y, 6.0 + (is_mirrored ? -z : z)});  // 20 further, with a straight piece between them
  return points;
}

TEST(KnotThrows, OfASumAreItsSummandsWithoutTheThreadBetweenThem) {
  for (const bool is_square : {true, false}) {
    const Points points = two_overhands(is_square);
    const auto whole = knot::recognise(points, false);
    ASSERT_EQ(whole.type, "3_1#3_1");
    ASSERT_EQ(whole.handedness == "amphichiral", is_square);
    const KnotCore core = find_core(points, whole);
    const auto throws = find_throws(points, whole, core);
    ASSERT_EQ(throws.size(), 2U);
    EXPECT_LT(throws[0].last, throws[1].first);
    for (const KnotCore& one : throws) {
      const std::span piece(points.data() + one.first, one.last - one.first + 1);
      EXPECT_EQ(knot::recognise(piece, false).type, "3_1");
    }
  }
}

/// Two long trefoils [Shastri 1992] in a row, the second one mirrored, bent by a wave; the same shape as in
/// tests/browser/fake_rig.py.
Points swaying(int nodes, double sway) {
  Points points;
  for (int i = 0; i < nodes; ++i) {
    const int half = nodes / 2;
    const bool is_second = i >= half;
    const double t = -2.12 + 4.24 * (i % half) / (half - 1);
    const double x = 0.33 * (t * t * t - 3.0 * t), y = 0.09 * (t * t * t * t - 4.0 * t * t);
    const double z = 1.7 + 0.06 * (std::pow(t, 5) - 10.0 * t) + (is_second ? 3.5 : 0.0);
    points.push_back({x + (is_second ? 3.0 : 0.0) + sway * std::sin(5.0 * z), is_second ? 0.4 - y : y, z});
  }
  return points;
}

TEST(KnotThrows, AreFoundInEachShapeOfAMovingThread) {
  int found = 0;
  for (int i = -20; i <= 20; ++i) {
    const Points points = swaying(120, 1e-3 * i);
    const auto whole = knot::recognise(points, false);
    ASSERT_EQ(whole.type, "3_1#3_1");
    if (find_throws(points, whole, find_core(points, whole)).size() == 2) ++found;
  }
  EXPECT_EQ(found, 41);
}

TEST(KnotThrows, OfAPrimeKnotIsTheKnotAndOfNoKnotNothing) {
  const auto points = test::overhand_points(160);
  const auto whole = knot::recognise(points, false);
  const KnotCore core = find_core(points, whole);
  const auto throws = find_throws(points, whole, core);
  ASSERT_EQ(throws.size(), 1U);
  EXPECT_EQ(throws[0].first, core.first);
  EXPECT_EQ(throws[0].last, core.last);
  EXPECT_TRUE(find_throws(test::straight_points(60), {}, {}).empty());
}

}  // namespace
}  // namespace ligature::host::view
