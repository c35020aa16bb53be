// Contact with a desk and a peg: Coulomb's thresholds, true stick, the capstan, a rod lifted from a plane.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/unit/rod/reference.hpp"
#include "tests/unit/rod/rods.hpp"

namespace ligature::test {
namespace {

constexpr Parts kOnADesk{false, false, true, true, false};
constexpr double kG = 9.81;

/// 3 cm of a 0.3 mm thread lying on the plane z = 0.
Rod lying(double mu, int n) {
  Material m;
  m.length_m = 0.03;
  m.drag_per_s = 0.0;
  Rod rod(m, Numerics{}, kOnADesk, n);
  rod.has_floor = true;
  rod.floor_friction = mu;
  for (auto& x : rod.state().x) x += make(0, 0, m.radius_m);
  rod.gravity = make(0, 0, -kG);
  rod.moved();
  return rod;
}

Vec tilted(double degrees) {
  const double a = degrees * std::numbers::pi / 180.0;
  return make(0, kG * std::sin(a), -kG * std::cos(a));
}

double along(const Rod& rod) { return rod.state().x[rod.state().x.size() / 2][1]; }

TEST(Incline,
     HoldsBelowTheFrictionAngleAndSlidesAbove) {  // atan(mu), +- 0.5 degrees; creep below 1e-3 diameters per second
  for (const double mu : {0.1, 0.3, 0.5}) {
    const double threshold = std::atan(mu) * 180.0 / std::numbers::pi;
    Rod below = lying(mu, 20);
    for (int k = 0; k < 100; ++k) below.tick();
    below.gravity = tilted(threshold - 0.5);
    for (int k = 0; k < 100; ++k) below.tick();
    const double from = along(below);
    for (int k = 0; k < 1000; ++k) below.tick();
    EXPECT_LT(std::abs(along(below) - from), 1e-3 * 2.0 * below.material().radius_m) << mu;

    Rod above = lying(mu, 20);
    above.gravity = tilted(threshold + 0.5);
    for (int k = 0; k < 1000; ++k) above.tick();
    const double a = (threshold + 0.5) * std::numbers::pi / 180.0;
    const double distance = 0.5 * kG * (std::sin(a) - mu * std::cos(a));
    EXPECT_NEAR(along(above) / distance, 1.0, 0.02) << mu;
  }
}

TEST(SlidingThread, StopsAfterItsStoppingDistance) {  // v^2 / 2 mu g
  for (const auto& row : read_table("05_stopping_distance.csv").rows) {
    const double mu = number(row, "mu"), speed = number(row, "v0_m_s");
    if (speed < 0.05 || speed > 0.6) continue;
    Rod rod = lying(mu, 20);
    for (int k = 0; k < 50; ++k) rod.tick();
    const double from = along(rod);
    for (auto& v : rod.state().v) v = make(0, speed, 0);
    const int ticks = static_cast<int>(1000.0 * number(row, "time_s")) + 50;
    for (int k = 0; k < ticks; ++k) rod.tick();
    EXPECT_NEAR((along(rod) - from) / number(row, "distance_m(g=9.81)"), 1.0, 0.02) << mu << " " << speed;
  }
}

TEST(Capstan, TensionRatioApproachesExpMuTheta) {  // half a turn round a smooth peg, pulled slowly at one end
  for (const double mu : {0.1, 0.3}) {
    const double radius = 0.02;
    const int n = 120;
    Material m;
    m.length_m = 0.16;
    m.EI_N_m2 = 1e-11;
    m.EA_N = 1000.0;
    Parts parts = kOnADesk;
    Rod rod(m, Numerics{}, parts, n, 1);
    rod.bodies.push_back({make(0, -1, 0), make(0, 1, 0), radius - m.radius_m, Vec{}, mu});
    rod.moved();
    const double arc = std::numbers::pi * radius, tail = 0.5 * (m.length_m - arc);
    for (std::size_t i = 0; i < n; ++i) {  // up one side, over the top, down the other
      const double s = rod.state().mesh.s[i];
      const double a = (s - tail) / radius;
      rod.state().x[i] = s < tail         ? make(-radius, 0, s - tail)
                         : s < tail + arc ? make(-radius * std::cos(a), 0, radius * std::sin(a))
                                          : make(radius, 0, tail + arc - s);
    }
    rod.state().load[0] = make(0, 0, -1.0);
    const Vec start = rod.state().x[n - 1];
    const int hand = rod.grip(n - 1, 1000.0, 0.5, start);
    std::array<Vec, physics::rod::kMaxHolds> goals{};
    double sum = 0.0;
    const int ticks = 1500, counted = 500;
    for (int k = 0; k < ticks; ++k) {
      goals[static_cast<std::size_t>(hand)] = start - make(0, 0, 0.005 * 1e-3 * (k + 1));
      rod.tick(goals);
      if (k >= ticks - counted) sum += rod.state().holds[static_cast<std::size_t>(hand)].force[2] / counted;
    }
    EXPECT_NEAR(sum / std::exp(mu * std::numbers::pi), 1.0, 0.02) << mu;
  }
}

TEST(HeavyRod,
     LiftedFromAPlane) {  // nonlinear boundary value problem, 1e-9; end force in units of w Lb, Lb = (B / w)^(1/3)
  for (const auto& row : read_table("06_heavy_rod_lifted_from_plane.csv").rows) {
    const double height = number(row, "H_over_Lb");
    if (height < 0.05 || height > 1.0) continue;
    const int n = 200;
    Material m = unit_rod();
    m.length_m = 5.0;
    m.EA_N = 1e5;
    m.drag_per_s = 3.0;
    m.bend_tau_s = 0.05;
    Numerics q = steps_of(0.02);
    q.max_passes = 60, q.passes_per_substep = 60, q.contact_N_per_m = 1e6, q.settled_m_per_s = 1e-6;
    Rod rod(m, q, Parts{false, false, false, true, false}, n);
    rod.has_floor = true;
    rod.floor_friction = 0.0;
    rod.gravity = make(0, 0, -1.0);
    for (auto& x : rod.state().x) x += make(0, 0, m.radius_m);
    rod.moved();
    const int hold = rod.grip(0, 1e5, 0.0, rod.state().x[0]);
    std::array<Vec, physics::rod::kMaxHolds> goals{};
    for (int k = 0; k < 1500; ++k) {
      goals[static_cast<std::size_t>(hold)] = make(0, 0, m.radius_m + height * std::min(1.0, k / 500.0));
      rod.tick(goals);
    }
    const double force = -rod.state().holds[static_cast<std::size_t>(hold)].force[2];
    // The hand carries no half segment more than the rod's own lumped end mass.
    EXPECT_NEAR(force / number(row, "lift_force_over_wLb"), 1.0, 0.01) << height;
  }
}

}  // namespace
}  // namespace ligature::test
