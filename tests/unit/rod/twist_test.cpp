// The rod's twist force is minus the gradient of its twist energy. (`ligature-lab validate` tests the instabilities
// that twist causes.)

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/rod/rods.hpp"

namespace ligature::test {
namespace {

using physics::rod::assemble;
using physics::rod::BandSolver;
using physics::rod::Forces;

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

}  // namespace
}  // namespace ligature::test
