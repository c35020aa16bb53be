#include <gtest/gtest.h>

#include "host/view/knot_watch.hpp"
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

}  // namespace
}  // namespace ligature::host::view
