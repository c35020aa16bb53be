// Static friction mu_s above the kinetic mu_k: a resting thread holds up to mu_s, a sliding one is braked by mu_k.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/unit/rod/rods.hpp"

namespace ligature::test {
namespace {

constexpr double kG = 9.81, kSlide = 0.2, kStick = 0.4;
constexpr Parts kRubbing{.twist = false, .contact = true, .friction = true, .world = true};

/// A thread on a desk that is tilted by `angle` about the thread's axis.
Rod lying(double angle, int nodes = 30) {
  Material m;
  m.length_m = 0.03;
  m.drag_per_s = 0.0;
  m.friction = kSlide;
  m.static_friction = kStick;
  Rod rod(m, Numerics{}, kRubbing, nodes, 1);
  rod.has_floor = true;
  rod.floor_friction = kSlide;
  for (auto& x : rod.state().x) x += make(0, 0, m.radius_m);
  rod.moved();
  rod.gravity = make(0, kG * std::sin(angle), -kG * std::cos(angle));
  return rod;
}

void run(Rod& rod, int ticks) {
  for (int k = 0; k < ticks; ++k) rod.tick();
}

// The desk is tilted slowly, as in a measurement of mu_s.
TEST(StaticFriction, HoldsUpToItsOwnConeAndCreepsNowhere) {
  Rod rod = lying(0.0);
  run(rod, 50);
  for (int k = 1; k <= 200; ++k) {
    const double angle = (std::atan(kStick) - 0.01) * k / 200.0;
    rod.gravity = make(0, kG * std::sin(angle), -kG * std::cos(angle));
    rod.tick();
  }
  const double from = rod.state().x[15][1];
  run(rod, 1000);
  EXPECT_LT(std::abs(rod.state().x[15][1] - from), 1e-3 * 2.0 * rod.material().radius_m);
}

TEST(StaticFriction, OnceItSlidesOnlyTheKineticOneBrakes) {
  const double angle = std::atan(kStick) + 0.01;
  Rod rod = lying(angle);
  run(rod, 100);
  const double v0 = rod.state().v[15][1];
  run(rod, 100);
  const double a = kG * (std::sin(angle) - kSlide * std::cos(angle));
  EXPECT_NEAR(rod.state().v[15][1] - v0, 0.1 * a, 0.01 * 0.1 * a);
}

// On a slope between the two friction angles (atan mu_k and atan mu_s) a pushed thread keeps sliding, and a resting
// thread stays at rest.
TEST(StaticFriction, BetweenTheConesMotionDecides) {
  const double angle = std::atan(0.3), a = kG * (std::sin(angle) - kSlide * std::cos(angle));
  Rod pushed = lying(angle), left = lying(angle);
  for (auto& v : pushed.state().v) v = make(0, 0.05, 0);
  run(pushed, 100);
  run(left, 100);
  EXPECT_NEAR(pushed.state().v[15][1], 0.05 + 0.1 * a, 0.01 * 0.1 * a);
  EXPECT_LT(std::abs(left.state().v[15][1]), 1e-6);
}

// On a level desk a pushed thread stops by the kinetic coefficient, then holds up to the static one.
TEST(StaticFriction, StopsByTheKineticAndHoldsByTheStatic) {
  Rod rod = lying(0.0);
  for (auto& v : rod.state().v) v = make(0, 0.1, 0);
  const double from = rod.state().x[15][1];
  run(rod, 200);
  EXPECT_NEAR(rod.state().x[15][1] - from, 0.1 * 0.1 / (2.0 * kSlide * kG), 0.02 * 0.1 * 0.1 / (2.0 * kSlide * kG));
  const double angle = std::atan(0.35);
  rod.gravity = make(0, kG * std::sin(angle), -kG * std::cos(angle));
  const double rest = rod.state().x[15][1];
  run(rod, 300);
  EXPECT_LT(std::abs(rod.state().x[15][1] - rest), 1e-3 * 2.0 * rod.material().radius_m);
}

// A thread on a level desk, with kinetic friction alone. Sweeps that end at a fixed tolerance leave it a speed of up to
// that size: without Tuning::creep it moves at 0.65 um/s, with it at 0.07 um/s.
TEST(Friction, AThreadAtRestHardlyCreeps) {
  Material m;
  m.length_m = 0.06;
  Rod rod(m, Numerics{}, Parts{.twist = false, .contact = true, .friction = true, .world = true}, 30);
  rod.has_floor = true;
  rod.floor_friction = kSlide;
  rod.gravity = make(0, 0, -kG);
  for (auto& x : rod.state().x) x += make(0, 0, m.radius_m);
  rod.moved();
  run(rod, 500);
  const auto rest = rod.state().x;
  run(rod, 1000);
  double most_m = 0.0;
  for (std::size_t i = 0; i < rest.size(); ++i) most_m = std::max(most_m, norm(rod.state().x[i] - rest[i]));
  EXPECT_LT(most_m, 0.2e-6);
}

// A thread of the shipped length whose nodes all touch the desk. With sixteen substeps its contacts need more work than
// the budget allows.
TEST(Labour, FindsTimeForAThreadAllOfWhichSlides) {
  Material m;  // length 0.3 m
  m.drag_per_s = 0.0;
  m.friction = kSlide;
  Rod rod(m, Numerics{}, kRubbing, 154, 1);
  rod.has_floor = true;
  rod.floor_friction = kSlide;
  for (auto& x : rod.state().x) x += make(0, 0, m.radius_m);
  for (auto& v : rod.state().v) v = make(0, 0.5, 0);
  rod.moved();
  rod.gravity = make(0, 0, -kG);
  double lost = 0.0;
  for (int k = 0; k < 100; ++k) rod.tick(), lost += 0.01 * rod.report().time_lost;
  EXPECT_LT(lost, 0.01);
  EXPECT_NEAR(rod.state().v[77][1], 0.5 - 0.1 * kSlide * kG, 0.005);
}

}  // namespace
}  // namespace ligature::test
