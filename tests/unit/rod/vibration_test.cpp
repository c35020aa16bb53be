// Natural frequencies by zero crossings of the modal amplitude.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/unit/rod/reference.hpp"
#include "tests/unit/rod/rods.hpp"

namespace ligature::test {
namespace {

// Mode shape of a cantilever, clamped at s = 0 [Euler-Bernoulli].
double cantilever_shape(double beta, double s) {
  const double c = (std::cosh(beta) + std::cos(beta)) / (std::sinh(beta) + std::sin(beta));
  return std::cosh(beta * s) - std::cos(beta * s) - c * (std::sinh(beta * s) - std::sin(beta * s));
}

// Angular frequency from the mean distance of zero crossings of q over `periods` half periods.
template <class Amplitude>
double measured(Rod& rod, double tick_s, int crossings, Amplitude q) {
  double before = q(rod), first = 0.0, last = 0.0, t = 0.0;
  for (int seen = 0; seen <= crossings;) {
    rod.tick();
    t += tick_s;
    const double now = q(rod);
    if ((before > 0.0) != (now > 0.0)) {
      const double at = t - tick_s * now / (now - before);
      if (seen == 0) first = at;
      last = at;
      ++seen;
    }
    before = now;
  }
  return std::numbers::pi * crossings / (last - first);
}

TEST(Cantilever, FirstThreeFrequencies) {  // lumping lowers them by O(1 / N^2); implicit Euler by (omega dt)^2 / 3
  const double betas[] = {1.87510406871, 4.69409113297, 7.85475743824}, tolerance[] = {0.01, 0.03, 0.03};
  for (const int n : {50, 200}) {
    for (int k = 0; k < 3; ++k) {
      const double beta = betas[k], omega = beta * beta, tick = 0.02 / omega;
      Rod rod(unit_rod(), steps_of(tick), kBare, n);
      rod.clamp(0, make(0, 0, 0), make(1, 0, 0));
      for (std::size_t i = 0; i < rod.state().x.size(); ++i) {
        rod.state().x[i] += make(0, 1e-4 * cantilever_shape(beta, rod.state().mesh.s[i]), 0);
      }
      const double found = measured(rod, tick, 6, [&](const Rod& r) {  // projection on the mode: others drop out
        double q = 0.0;
        for (std::size_t i = 0; i < r.state().x.size(); ++i) {
          q += r.state().mesh.mass[i] * cantilever_shape(beta, r.state().mesh.s[i]) * r.state().x[i][1];
        }
        return q;
      });
      EXPECT_NEAR(found / omega, 1.0, tolerance[k]) << "mode " << k + 1 << ", N = " << n;
    }
  }
}

TEST(HangingChain,
     HasTheFrequenciesOfItsMasses) {  // N masses at the ends of N links: zeros of Laguerre polynomials, exact
  for (const auto& row : read_table("03_hanging_chain_modes_discrete.csv").rows) {
    const int masses = static_cast<int>(number(row, "N_masses")), mode = static_cast<int>(number(row, "mode"));
    if (masses < 10 || mode > 3) continue;
    const int n = masses + 1;
    const double omega = number(row, "omega_times_sqrt(L_over_g)"), tick = 0.02 / omega;
    Material m = unit_rod();
    m.EI_N_m2 = 0.0;
    Rod rod(m, steps_of(tick), kBare, n);
    auto& state = rod.state();
    rod.gravity = make(0, 0, -1);
    rod.support(0, make(0, 0, 0));
    rod.moved();
    for (auto& mass : state.mesh.mass) mass = 1.0 / masses;  // equal masses: the last is not half
    // Mode shape: Laguerre recurrence from the free end, y_N = 1: tension in link j is the weight below it.
    std::vector<double> y(static_cast<std::size_t>(n), 1.0);
    const double l = 1.0 / masses;
    double slope = 0.0;  // of link k above, from below
    for (int k = n - 1; k > 0; --k) {
      const double below = n - 1 - k;  // weights below link k + 1, in units of m g
      slope = (below * slope + omega * omega * y[static_cast<std::size_t>(k)]) / (below + 1.0);
      y[static_cast<std::size_t>(k - 1)] = y[static_cast<std::size_t>(k)] - l * slope;
    }
    for (std::size_t i = 0; i < y.size(); ++i) state.x[i] = make(1e-4 * (y[i] - y[0]), 0, -state.mesh.s[i]);
    const double found = measured(rod, tick, 6, [&](const Rod& r) {
      double q = 0.0;
      for (std::size_t i = 0; i < y.size(); ++i) q += y[i] * r.state().x[i][0];
      return q;
    });
    EXPECT_NEAR(found / omega, 1.0, 5e-3) << masses << " masses, mode " << mode;
  }
}

}  // namespace
}  // namespace ligature::test
