// The simulated operator: what it perceives of the thread (arc length, loops to pass through), and that it ties the
// requested knot with any seed.

#include <gtest/gtest.h>

#include <cmath>

#include "sim_device/operator/diagram.hpp"
#include "sim_device/operator/ring.hpp"
#include "tests/support/expect_tied.hpp"
#include "tests/unit/sim_device/tied.hpp"

namespace ligature::sim {
namespace {

using ligature::test::expect_tied;
using test::recognised;
using test::tied;

std::vector<Vec3> circle(int n, double radius_m) {
  std::vector<Vec3> points;
  for (int k = 0; k < n; ++k) {
    const double a = 2.0 * M_PI * k / n;
    points.emplace_back(radius_m * std::cos(a), radius_m * std::sin(a), 0.0);
  }
  return points;
}

TEST(ThreadView, SpeaksInArcLength) {
  const std::vector<Vec3> corner{{0, 0, 0}, {3, 0, 0}, {3, 4, 0}};
  ThreadView view;
  view.look(corner);
  EXPECT_DOUBLE_EQ(view.length_m(), 7.0);
  EXPECT_TRUE(view.at(5.0).isApprox(Vec3(3, 2, 0)));
  EXPECT_TRUE(view.along(5.0).isApprox(Vec3::UnitY()));
  EXPECT_DOUBLE_EQ(view.nearest(Vec3(4, 1, 0)), 4.0);
  EXPECT_DOUBLE_EQ(view.nearest(Vec3(4, 1, 0), 0.0, 2.0), 2.0);
  const auto back = view.between(5.0, 1.0);
  ASSERT_EQ(back.size(), 3u);
  EXPECT_TRUE(back.front().isApprox(Vec3(3, 2, 0)));
  EXPECT_TRUE(back.back().isApprox(Vec3(1, 0, 0)));
}

TEST(Ring, HasACentreANormalAndAnArea) {
  const Ring ring(circle(12, 1.0));
  EXPECT_NEAR(ring.area_m2(), 3.0, 1e-12);  // area of the regular twelve-sided polygon
  EXPECT_TRUE(ring.normal().isApprox(Vec3::UnitZ()));
  EXPECT_LT(ring.centre().norm(), 1e-12);
}

/// Points of an overhand or figure-eight knot as one draws it: the thread comes from the right, turns down at a corner,
/// runs back below itself, up in front of its first part (y < 0), over it, and down behind it; then the end. side -1
/// gives the mirror image in y.
std::vector<Vec3> drawn(bool figure_eight, double side) {
  std::vector<Vec3> p{{3, 0, 0}, {-3, 0, 0}, {-3, 0, -2}, {0, 0, -2}, {0, -0.5, 0}, {0, 0, 1}, {1.5, 0.3, 1}};
  p.insert(p.end(), {{1.5, 0.5, 0}, {1.5, 0.2, -1}});
  if (figure_eight)  // another turn in front of the rising strand, then through the loop from the front
    p.insert(p.end(), {{0, -1, -1}, {-1.5, -1, -1}, {-1.5, 1, -1}, {-1.5, 1, -4}});
  else  // behind that strand, then through the loop from behind
    p.insert(p.end(), {{0, 1, -1}, {-1.5, 1, -1}, {-1.5, -1, -1}, {-1.5, -1, -4}});
  for (Vec3& q : p) q.y() *= side;
  return p;
}

TEST(PlannedKnots, AreTheNamedOnesInBothHands) {
  EXPECT_EQ(recognised(drawn(false, 1.0)).type, "3_1");
  EXPECT_EQ(recognised(drawn(false, -1.0)).type, "3_1");
  EXPECT_NE(recognised(drawn(false, 1.0)).handedness, recognised(drawn(false, -1.0)).handedness);
  EXPECT_EQ(recognised(drawn(true, 1.0)).type, "4_1");
  EXPECT_EQ(recognised(drawn(true, -1.0)).type, "4_1");
}

TEST(SeenDeterminant, TellsThemApartFromTheirPicture) {
  const Vec3 from_below(0.1, 0.2, -1.0);  // view direction; both ends are led away downwards, clear of the loop
  for (const double side : {1.0, -1.0}) {
    EXPECT_EQ(seen_determinant(drawn(false, side), from_below), 3);
    EXPECT_EQ(seen_determinant(drawn(true, side), from_below), 5);
  }
  const std::vector<Vec3> straight{{0, 0, 0}, {0, 0.1, -1}, {0, 0, -2}};
  EXPECT_EQ(seen_determinant(straight, Vec3::UnitY()), 1);
  auto slipped = drawn(true, 1.0);
  slipped.resize(slipped.size() - 2);  // the end has not yet passed through the loop
  EXPECT_EQ(seen_determinant(slipped, -Vec3::UnitY()), 1);
}

// The next tests tie without devices, with random operators in scenes that must tie. How often operators succeed
// through the whole chain is in docs/measurements/tying.md.

/// A random operator ties this knot.
auto tying(const char* scene, const char* knot, const std::vector<std::string>& overrides = {}) {
  return [=](std::uint32_t seed) { return tied(scene, knot, seed, overrides); };
}

TEST(KnotTier, TiesAnOverhandInThePapersSuture) {  // checked five seconds after the hands let go
  expect_tied("3_1 right", 81, tying("paper.toml", "overhand"));
  expect_tied("3_1 right", 82, tying("paper.toml", "overhand", {"suture.model=\"paper-1\""}));
}

TEST(KnotTier, TiesAFigureEightInThePapersSuture) {
  expect_tied("4_1 amphichiral", 83, tying("paper.toml", "figure-eight"));
}

TEST(KnotTier, TiesARealSutureFromScratch) {  // 0.3 mm nylon, tightened to 1 N and released
  expect_tied("3_1 right", 84, tying("suture-3-0.toml", "overhand"), 2);
}

TEST(KnotTier, TiesASquareKnotInARealSuture) {
  expect_tied("3_1#3_1 amphichiral", 85, tying("suture-3-0.toml", "square"), 1);
}

TEST(KnotTier, TiesAnOverhandInCoarseAndFineChains) {
  expect_tied(
      "3_1 right", 86,
      [](std::uint32_t seed) {
        const std::string nodes = "suture.nodes=" + std::to_string(20 + seed % 81);
        return tied("paper.toml", "overhand", seed, {nodes});
      },
      6);
}

TEST(KnotTier, RefusesACoarseOrShortThread) {
  const std::string coarse = tied("paper.toml", "square", 1, {"suture.nodes=20"});
  EXPECT_TRUE(coarse.starts_with("suture.nodes: found 20, allowed 43 or more")) << coarse;
  const std::string brief = tied("paper.toml", "surgeon", 1);
  EXPECT_TRUE(brief.starts_with("suture.length_m: found 5, allowed 6 or more")) << brief;
}

TEST(KnotTier, RefusesWhatItCannotTie) {
  scene::Scene free_thread;
  free_thread.world.fixed.clear();
  EXPECT_TRUE(std::holds_alternative<std::string>(KnotTier::make(free_thread, "overhand", 1)));
  free_thread.world.fixed = {{0, {0.0, 0.0, 5.5}, std::nullopt}};
  EXPECT_TRUE(std::holds_alternative<std::string>(KnotTier::make(free_thread, "bow tie", 1)));
  EXPECT_TRUE(std::holds_alternative<KnotTier>(KnotTier::make(free_thread, "overhand", 1)));
}

}  // namespace
}  // namespace ligature::sim
