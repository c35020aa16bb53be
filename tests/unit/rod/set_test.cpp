// Plastic bending: the curvature that stays after a sharp bend, compared with closed forms.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/unit/rod/rods.hpp"

namespace ligature::test {
namespace {

using physics::rod::kMaxHolds;
using physics::rod::State;

constexpr Parts kSets{
    .twist = true, .contact = false, .friction = false, .world = false, .adaptive = false, .set = true};
constexpr double kYield = 1.0;  // yield curvature, 1/m

Material setting_rod(double set_fraction) {
  Material m = unit_rod();
  m.bend_tau_s = 0.01;
  m.drag_per_s = 2.0;
  m.yield_curvature_per_m = kYield;
  m.set_fraction = set_fraction;
  return m;
}

/// A rod along x, clamped at both ends and bent into circular arcs by turning its far end.
class Bender {
 public:
  explicit Bender(const Material& m, int nodes = 61, Parts parts = kSets) : rod(m, steps_of(1e-3), parts, nodes) {
    near_ = rod.clamp(0, make(0, 0, 0), make(1, 0, 0));
    far_ = rod.clamp(nodes - 1, make(1, 0, 0), make(1, 0, 0));
  }
  /// Changes the curvature slowly, so that the rod is always an arc. @param watch called after each tick.
  void bend(
      double to, int ticks, const std::function<void()>& watch = [] {}) {
    const double from = curvature_;
    for (int k = 1; k <= ticks; ++k) {
      curvature_ = from + (to - from) * k / ticks;
      const double a = curvature_, x = a == 0.0 ? 1.0 : std::sin(a) / a, z = a == 0.0 ? 0.0 : (1.0 - std::cos(a)) / a;
      std::array<Vec, kMaxHolds> goals{};
      goals[static_cast<std::size_t>(near_)] = make(0, 0, 0);
      goals[static_cast<std::size_t>(far_)] = make(x, 0, z);
      hold(far_).direction = make(std::cos(a), 0, std::sin(a));
      rod.tick(goals);
      lost_J += rod.report().set_J;
      watch();
    }
  }
  void let_go(int ticks) {
    rod.release(far_);
    for (int k = 0; k < ticks; ++k) rod.tick();
  }
  physics::rod::Hold& hold(int h) { return rod.state().holds[static_cast<std::size_t>(h)]; }
  physics::rod::Hold& near() { return hold(near_); }
  /// The turn of the tangent at a vertex, as a vector; proportional to the curvature.
  [[nodiscard]] Vec turn(std::size_t i) const {
    const State& s = rod.state();
    return s.mesh.inv_rest[i] * (s.x[i + 1] - s.x[i]) - s.mesh.inv_rest[i - 1] * (s.x[i] - s.x[i - 1]);
  }
  [[nodiscard]] double curvature(std::size_t i) const {
    return norm(turn(i)) / (0.5 * (rod.state().mesh.rest[i - 1] + rod.state().mesh.rest[i]));
  }
  Rod rod;
  double lost_J = 0.0;  ///< dissipated by plastic bending

 private:
  int near_, far_;
  double curvature_ = 0.0;
};

TEST(Set, BelowYieldNothingDiffersInAnyBit) {
  Bender with(setting_rod(0.4)), without(setting_rod(0.4), 61, kTwisting);
  with.bend(0.7, 2000), without.bend(0.7, 2000);
  EXPECT_EQ(with.lost_J, 0.0);
  for (std::size_t i = 0; i < 61; ++i)
    for (int k = 0; k < 3; ++k) EXPECT_EQ(with.rod.state().x[i][k], without.rod.state().x[i][k]) << i;
}

// A rod of bending stiffness B is bent to the curvature kappa, which exceeds the yield curvature kappa_y by z. The
// moment is then B (kappa - f z), with f the material's set fraction, and after unloading the curvature f z stays.
TEST(Set, WhatABendKeepsIsItsFractionOfWhatExceedsYield) {
  for (const double f : {0.3, 0.5, 0.8}) {
    Bender b(setting_rod(f));
    b.bend(2.2, 8000);
    b.bend(2.2, 2000);
    constexpr std::size_t kAt[] = {20, 30, 40};
    double bent[3];
    for (std::size_t k = 0; k < 3; ++k) {
      bent[k] = b.curvature(kAt[k]) - kYield;
      EXPECT_NEAR(bent[k], 1.2, 0.1);
      EXPECT_NEAR(norm(b.rod.spin().set(static_cast<int>(kAt[k]))) * 60.0, bent[k], 0.01 * bent[k]);
    }
    b.bend(f * bent[1], 6000);  // slow unloading: an oscillation would bend the rod beyond yield again near the clamp
    b.let_go(4000);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(b.curvature(kAt[k]), f * bent[k], 0.01 * f * bent[k]) << f;
  }
}

// After a bend beyond kappa_y (2 - f) / (1 - f) (kappa_y yield curvature, f set fraction) the rod springs back so
// strongly that it yields in reverse, and only f kappa_y / (1 - f) stays.
TEST(Set, OfASharpBendItKeepsNoMoreThanTheOtherShareAllows) {
  Bender b(setting_rod(0.3));
  b.bend(4.0, 12000);
  b.bend(4.0, 2000);
  b.bend(0.43, 12000);
  b.bend(0.43, 2000);
  b.let_go(4000);
  const double kept = 0.3 * kYield / 0.7;
  // The tolerance is 2 %: small oscillations during unloading make it yield a little further.
  for (const std::size_t i : {20U, 30U, 40U}) EXPECT_NEAR(b.curvature(i), kept, 0.02 * kept);
}

// Bent to and fro between curvatures +k and -k, the hysteresis loop of moment and curvature has the area 4 f B k_y (k -
// k_y) per length (f set fraction, B bending stiffness, k_y yield curvature).
TEST(Set, ALoopCostsItsArea) {
  constexpr double f = 0.4, k = 2.0;
  Bender b(setting_rod(f));
  double area = 0.0, moment = 0.0, turn = 0.0, most = 0.0;
  const auto watch = [&] {  // signed by the side to which the thread bends
    const State& s = b.rod.state();
    const Vec t = s.x[31] - s.x[30], aside = (1.0 / norm(t)) * make(-t[2], 0, t[0]), bend = b.turn(30);
    const double now = dot(bend, aside), m = s.mesh.weight[30] * dot(bend - s.rest_bend[30], aside);
    area += 0.5 * (m + moment) * (now - turn);
    moment = m, turn = now;
    most = std::max(most, norm(bend));
    EXPECT_GE(b.rod.report().set_J, 0.0);
  };
  b.bend(k, 6000, watch);
  area = most = b.lost_J = 0.0;
  b.bend(-k, 12000, watch);
  b.bend(k, 12000, watch);
  const double limit = kYield / 60.0, vertex = 4.0 * f * b.rod.state().mesh.weight[30] * limit * (most - limit);
  EXPECT_NEAR(area, vertex, 0.03 * vertex);
  EXPECT_NEAR(b.lost_J, 59.0 * vertex, 0.03 * 59.0 * vertex);
}

// Set curvature is fixed to the material: when the rod is clamped at one end and turned there about its axis, the whole
// bow turns with it.
TEST(Set, ABowTurnsWithItsMaterial) {
  for (const bool in_every_substep : {false, true}) {
    Parts parts = kSets;
    parts.roll = in_every_substep;
    Bender b(setting_rod(0.5), 61, parts);
    b.bend(2.4, 8000);
    b.let_go(6000);
    const Vec before = b.rod.state().x[60];
    ASSERT_GT(before[2], 0.2);
    for (int k = 0; k < 4000; ++k) {
      Twist::roll(b.near(), 1.2 / 4000.0);
      b.rod.tick();
    }
    for (int k = 0; k < 6000; ++k) b.rod.tick();
    const Vec now = b.rod.state().x[60];
    EXPECT_NEAR(std::atan2(-now[1], now[2]), 1.2, 0.012);
    EXPECT_NEAR(std::hypot(now[1], now[2]), before[2], 0.01 * before[2]);
    EXPECT_NEAR(now[0], before[0], 0.01);
  }
}

// No external forces: plastic bending may only reduce the energy.
TEST(Set, EnergyNeverRises) {
  Material m = setting_rod(0.6);
  m.drag_per_s = 0.0;
  Rod rod(m, steps_of(1e-3), kSets, 41);
  State& s = rod.state();
  for (std::size_t i = 1; i < 41; ++i) {
    const double a = 9.0 * s.mesh.s[i];
    s.x[i] = s.x[i - 1] + (s.mesh.s[i] - s.mesh.s[i - 1]) * make(0.8 * std::cos(a), 0.8 * std::sin(a), 0.6);
    s.v[i] = make(0.5 * std::cos(2.0 * a), 0.0, 0.5 * std::sin(a));
  }
  rod.moved();
  const auto energy = [&] {
    const auto e = rod.energy();
    return e.kinetic_J + e.stretch_J + e.bend_J + rod.twist_energy_J();
  };
  double last = energy(), lost = 0.0;
  const double first = last;
  for (int k = 0; k < 3000; ++k) {
    rod.tick();
    lost += rod.report().set_J;
    EXPECT_LE(energy(), last + 1e-6 * first) << k;
    last = energy();
  }
  EXPECT_GT(lost, 0.05 * first);
  EXPECT_LT(lost, first);
}

// Remeshing preserves the total set curvature and does not move a thread at rest.
TEST(Set, MovingNodesKeepsIt) {
  Material m;
  m.length_m = 0.1;
  m.drag_per_s = 50.0;
  m.yield_curvature_per_m = 600.0;
  m.set_fraction = 0.6;
  Parts parts = kSets;
  parts.adaptive = true;
  Rod rod(m, Numerics{}, parts, 120);
  State& s = rod.state();
  for (std::size_t i = 1; i < s.x.size(); ++i) {  // curvature 2000 per m around s = 0.016 m
    const double at = 0.5 * (s.mesh.s[i - 1] + s.mesh.s[i]), a = 1.5 * (1.0 + std::tanh((at - 0.016) / 0.00075));
    s.x[i] = s.x[i - 1] + (s.mesh.s[i] - s.mesh.s[i - 1]) * make(std::cos(a), 0, std::sin(a));
  }
  rod.moved();
  rod.hold_mesh(true);
  for (int k = 0; k < 1500; ++k) rod.tick();
  const auto sum = [&] {
    double all = 0.0;
    for (std::size_t i = 1; i + 1 < s.x.size(); ++i) all += norm(rod.spin().set(static_cast<int>(i)));
    return all;
  };
  const double whole = sum();
  EXPECT_GT(whole, 0.5);
  int moved = 0;
  double fastest = 0.0;
  rod.hold_mesh(false);
  for (int k = 0; k < 300; ++k) {
    rod.tick();
    moved += rod.report().remeshes;
    EXPECT_EQ(rod.report().set_J, 0.0);
    for (const auto& v : s.v) fastest = std::max(fastest, norm(v));
  }
  EXPECT_NEAR(sum(), whole, 1e-9 * whole);
  EXPECT_GE(moved, 4);
  EXPECT_LT(fastest, 0.02);  // not zero: remeshing smooths a coarse bow
}

}  // namespace
}  // namespace ligature::test
