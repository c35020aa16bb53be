// Twist: its force against its energy, and three classic instabilities.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/unit/rod/reference.hpp"
#include "tests/unit/rod/rods.hpp"

namespace ligature::test {
namespace {

using physics::rod::assemble;
using physics::rod::BandSolver;
using physics::rod::Forces;
using physics::rod::Twist;

constexpr Parts kTwisting{true, false, false, false, false};
constexpr double kPi = std::numbers::pi;

/// Turns the last hold's end by `angle_rad` in steps that the turn counter can follow.
void wind(Rod& rod, int hold, double angle_rad) {
  const int steps = static_cast<int>(std::ceil(std::abs(angle_rad)));
  for (int k = 0; k < steps; ++k) {
    Twist::roll(rod.state().holds[static_cast<std::size_t>(hold)], angle_rad / steps);
    rod.tick();
  }
}

TEST(TwistForce, EqualsMinusTheGradientOfItsEnergy) {  // central differences, error ~ step^2
  Material m = unit_rod();
  m.EA_N = 10.0;
  m.EI_N_m2 = 0.0;
  m.GJ_N_m2 = 2.0;
  const int n = 12;
  Rod rod(m, steps_of(1e-9), kTwisting, n);
  auto& x = rod.state().x;
  for (std::size_t i = 0; i < n; ++i) {
    const double s = rod.state().mesh.s[i];
    x[i] = make(s, 0.2 * std::sin(4.0 * s), 0.2 * std::cos(5.0 * s) - 0.2);
  }
  rod.clamp(0, x[0], make(1, 0.4, 0.1));
  const int end = rod.clamp(n - 1, x[n - 1], make(0.6, -0.2, 0.9));
  wind(rod, end, 2.5);
  const auto energy = [&] {
    Forces scratch = rod.forces();
    rod.twist().update(m, rod.state(), scratch);
    const auto e = rod.energy();
    return e.stretch_J + e.bend_J + rod.twist().energy_J();
  };
  Forces forces = rod.forces();
  rod.twist().update(m, rod.state(), forces);
  for (auto& v : rod.state().v) v = Vec{};
  BandSolver solver;
  solver.resize(n);
  const double dt = 1e-6;
  assemble<true>(m, rod.state(), Vec{}, dt, forces, solver);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    for (int k = 0; k < 3; ++k) {
      const double h = 1e-6;
      const Vec step = make(k == 0 ? h : 0, k == 1 ? h : 0, k == 2 ? h : 0);
      x[i] += step;
      const double up = energy();
      x[i] -= 2.0 * step;
      const double down = energy();
      x[i] += step;
      EXPECT_NEAR(solver.rhs[i][k] / dt, -(up - down) / (2.0 * h), 2e-6) << "node " << i << " axis " << k;
    }
  }
}

// Does a small disturbance grow? The sum of squared distances from the trivial state, late against early.
template <class Distance>
bool grows(Rod& rod, int ticks, Distance distance) {
  for (int k = 0; k < ticks; ++k) rod.tick();
  const double early = distance(rod);
  for (int k = 0; k < ticks; ++k) rod.tick();
  return distance(rod) > early;
}

bool twisted_clamped_rod_buckles(int n, double moment) {
  Material m = unit_rod();
  m.EA_N = 1e4;
  m.drag_per_s = 50.0;
  Rod rod(m, steps_of(0.02), kTwisting, n);
  rod.clamp(0, make(0, 0, 0), make(1, 0, 0));
  const int end = rod.clamp(n - 1, make(1, 0, 0), make(1, 0, 0));
  wind(rod, end, moment * m.length_m / m.GJ_N_m2);
  for (std::size_t i = 1; i + 1 < rod.state().x.size(); ++i) {
    const double s = rod.state().mesh.s[i], bump = 1e-6 * (1.0 - std::cos(2.0 * kPi * s));
    rod.state().x[i] += make(0, bump * std::cos(4.5 * s), bump * std::sin(4.5 * s));
  }
  return grows(rod, 1500, [](const Rod& r) {
    double sum = 0.0;
    for (const auto& x : r.state().x) sum += x[1] * x[1] + x[2] * x[2];
    return sum;
  });
}

TEST(ClampedRod, BucklesUnderItsCriticalTwist) {  // ML/B = 8.98682, root of tan(x/2) = x/2
  for (const int n : {50, 200}) {
    EXPECT_FALSE(twisted_clamped_rod_buckles(n, 0.98 * 8.98682)) << n;
    EXPECT_TRUE(twisted_clamped_rod_buckles(n, 1.02 * 8.98682)) << n;
  }
}

bool twisted_ring_buckles(int n, double turns_over_critical, double bend_over_twist) {
  Material m = unit_rod();
  m.GJ_N_m2 = m.EI_N_m2 / bend_over_twist;
  m.drag_per_s = 50.0;
  Rod rod(m, steps_of(0.01), kTwisting, n);
  const double radius = m.length_m / (2.0 * kPi);
  for (std::size_t i = 0; i < rod.state().x.size(); ++i) {
    const double a = 2.0 * kPi * static_cast<double>(i) / (n - 1);
    rod.state().x[i] = make(radius * std::sin(a), radius * (1.0 - std::cos(a)), 0);
  }
  rod.clamp(0, make(0, 0, 0), make(1, 0, 0));
  const int end = rod.clamp(n - 1, make(0, 0, 0), make(1, 0, 0));
  const double angle = turns_over_critical * 2.0 * kPi * std::sqrt(3.0) * bend_over_twist;
  wind(rod, end, angle);
  for (std::size_t i = 1; i + 1 < rod.state().x.size(); ++i) {
    rod.state().x[i] += make(0, 0, 1e-6 * (1.0 - std::cos(4.0 * kPi * rod.state().mesh.s[i])));
  }
  for (int k = 0; k < 6500; ++k) rod.tick();
  return std::abs(rod.twist().turn_rad(0) - angle) > 1.0;  // a buckled ring turns over and gives twist to writhe
}

TEST(Ring, BucklesAtMichellsTwist) {  // sqrt(3) B / C turns [Michell 1890], clamped at one point: rigid motion only
  for (const double ratio : {1.0, 1.4}) {
    EXPECT_FALSE(twisted_ring_buckles(50, 0.98, ratio)) << ratio;
    EXPECT_TRUE(twisted_ring_buckles(50, 1.02, ratio)) << ratio;
  }
}

TEST(TwistedThread, FormsTheLocalisedHelix) {  // infinite-rod solution; finite length errs by exp(-21)
  const int n = 200;
  Material m;
  m.length_m = 100.0;
  m.density_kg_per_m = 1.0;
  m.EA_N = 1e5;
  m.EI_N_m2 = 1.345;
  m.GJ_N_m2 = 0.789;
  m.drag_per_s = 0.5;
  m.stretch_tau_s = m.bend_tau_s = 0.0;
  Rod rod(m, steps_of(0.1), kTwisting, n);
  rod.clamp(0, make(0, 0, 0), make(1, 0, 0));
  const int end = rod.clamp(n - 1, make(100, 0, 0), make(1, 0, 0));
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double s = rod.state().mesh.s[i] - 50.0;
    rod.state().x[i] += make(0, 1e-3 * std::exp(-s * s / 50.0), 0);
  }
  std::array<Vec, physics::rod::kMaxHolds> goals{};
  for (std::size_t h = 0; h < goals.size(); ++h) goals[h] = rod.state().holds[h].target;
  const int steps = 8000;
  for (int k = 0; k < steps; ++k) {
    Twist::roll(rod.state().holds[static_cast<std::size_t>(end)], 27.0 * 2.0 * kPi / steps);
    goals[static_cast<std::size_t>(end)] = make(100.0 - 3.0 * (k + 1) / steps, 0, 0);
    rod.tick(goals);
  }
  for (int k = 0; k < 20000; ++k) rod.tick();
  // Angle between tangent and axis; its largest value and the envelope around the middle of the bulge.
  const auto& x = rod.state().x;
  std::vector<double> cosine, place;
  for (std::size_t j = 0; j + 1 < x.size(); ++j) {
    const Vec e = x[j + 1] - x[j];
    cosine.push_back(e[0] / norm(e));
    place.push_back(0.5 * (rod.state().mesh.s[j] + rod.state().mesh.s[j + 1]));
  }
  double mass = 0.0, centre = 0.0, least = 1.0;
  for (std::size_t j = 0; j < cosine.size(); ++j) {
    mass += 1.0 - cosine[j];
    centre += place[j] * (1.0 - cosine[j]);
    least = std::min(least, cosine[j]);
  }
  centre /= mass;
  const double phi0 = 0.8316756961946656, sigma = 0.2175744904344096;  // 04_localised_helical_buckling.json, branch 1
  EXPECT_NEAR(std::acos(least) / phi0, 1.0, 0.02);
  for (std::size_t j = 0; j < cosine.size(); ++j) {
    const double f = (cosine[j] - least) / (1.0 - least), t = std::tanh(sigma * (place[j] - centre));
    EXPECT_NEAR(f, t * t, 0.03) << place[j];
  }
  EXPECT_NEAR(rod.twist().moment_Nm(0) / 1.3253831235025149, 1.0, 0.02);
}

}  // namespace
}  // namespace ligature::test
