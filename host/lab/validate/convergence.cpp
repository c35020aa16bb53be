#include "host/lab/validate/convergence.hpp"

#include <cmath>
#include <numbers>

#include "host/lab/validate/helix.hpp"
#include "host/lab/validate/reference.hpp"
#include "host/lab/validate/rods.hpp"

namespace ligature::validate {
namespace {

constexpr double kLoad = 10.0;  // P L^2 / EI: far outside the linear theory

Rod cantilever(int n, double step_s, int substeps, double drag_per_s) {
  Material m = unit_rod();
  m.EA_N = 1e9;
  m.drag_per_s = drag_per_s;
  Numerics numerics = steps_of(step_s);
  numerics.substeps = numerics.max_substeps = substeps;
  Rod rod(m, numerics, kBare, n);
  rod.clamp(0, make(0, 0, 0), make(1, 0, 0));
  rod.state().load[static_cast<std::size_t>(n - 1)] = make(0, -kLoad, 0);
  return rod;
}

double elastica_error(int n) {
  Rod rod = cantilever(n, 0.02, 1, 5.0);
  settle(rod, 1e-9, 20000);
  for (const auto& row : reference_rows("01_elastica_tip_load.csv")) {
    if (number(row, "PL2_over_EI") != kLoad) continue;
    const Vec truth = make(number(row, "tip_x_over_L"), -number(row, "tip_y_over_L"), 0);
    return norm(rod.state().x.back() - truth);
  }
  return 0.0;
}

/// Tip of the cantilever at the dimensionless time t = 0.25 after the load was applied, half way down; computed in 25
/// ticks.
Vec swung_tip(int substeps) {
  Rod rod = cantilever(50, 0.01, substeps, 0.0);
  for (int k = 0; k < 25; ++k) proceed(rod);
  return rod.state().x.back();
}

/// Error of the first frequency of a hanging chain, measured from the quarter period of the first mode: the time at
/// which its amplitude first crosses zero.
double chain_error(int n, double steps_per_unit) {
  const double truth = 1.20241277885;  // first zero of J0, divided by 2, times sqrt(g / L)
  const double dt = 1.0 / steps_per_unit;
  Material m = unit_rod();
  m.EI_N_m2 = 0.0;
  m.EA_N = 1e9;
  Rod rod(m, steps_of(dt), kBare, n);
  auto& state = rod.state();
  rod.gravity = make(0, 0, -1);
  rod.support(0, make(0, 0, 0));
  rod.moved();
  std::vector<double> y;
  y.reserve(state.mesh.s.size());
  for (const double s : state.mesh.s) y.push_back(std::cyl_bessel_j(0.0, 2.40482555769577 * std::sqrt(1.0 - s)));
  for (std::size_t i = 0; i < y.size(); ++i) state.x[i] = make(1e-5 * (y[i] - y[0]), 0, -state.mesh.s[i]);
  const auto amplitude = [&] {
    double q = 0.0;
    for (std::size_t i = 0; i < y.size(); ++i) q += state.mesh.mass[i] * y[i] * state.x[i][0];
    return q;
  };
  double before = amplitude(), t = 0.0, first = 0.0;
  for (int seen = 0; seen < 3;) {
    proceed(rod);
    t += dt;
    const double now = amplitude();
    if ((before > 0.0) != (now > 0.0)) {
      const double at = t - dt * now / (now - before);
      if (seen == 0) first = at;
      if (++seen == 3) return std::abs(2.0 * std::numbers::pi / (at - first) / truth - 1.0);
    }
    before = now;
  }
  return 0.0;
}

template <class Error>
Ladder ladder(const char* what, std::vector<double> resolution, Error error) {
  Ladder l{what, std::move(resolution), {}};
  for (const double r : l.resolution) l.error.push_back(error(r));
  return l;
}

}  // namespace

double Ladder::order() const {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  const auto n = static_cast<double>(error.size());
  for (std::size_t i = 0; i < error.size(); ++i) {
    const double x = std::log(resolution[i]), y = std::log(error[i]);
    sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  return -(n * sxy - sx * sy) / (n * sxx - sx * sx);
}

std::vector<Ladder> convergence() {
  std::vector<Ladder> all;
  all.push_back(ladder("elastica PL2/EI = 10, tip, of L, in N", {25, 50, 100, 200},
                       [](double n) { return elastica_error(static_cast<int>(n)); }));
  const Vec finest = swung_tip(5120);
  all.push_back(ladder("the same half way down (t = 0.25), against 5120 substeps, in substeps", {40, 80, 160, 320},
                       [&](double k) { return norm(swung_tip(static_cast<int>(k)) - finest); }));
  all.push_back(ladder("hanging chain, first frequency, relative, in N", {25, 50, 100, 200},
                       [](double n) { return chain_error(static_cast<int>(n), 5000.0); }));
  all.push_back(ladder("the same at N = 800, in steps per unit of time", {10, 20, 40, 80},
                       [](double k) { return chain_error(800, k); }));
  const double fine = localised_helix_of(800, 1, false).angle_rad;
  all.push_back(ladder("localised helix, largest angle, against N = 800, in N", {100, 200, 400}, [&](double n) {
    return std::abs(localised_helix_of(static_cast<int>(n), 1, false).angle_rad / fine - 1.0);
  }));
  const double still = localised_helix_of(100, 8, false).angle_rad;
  all.push_back(ladder(
      "the same at rest, N = 100, against 8 substeps: a balance knows no step", {1, 2, 4},
      [&](double k) { return std::abs(localised_helix_of(100, static_cast<int>(k), false).angle_rad / still - 1.0); }));
  return all;
}

}  // namespace ligature::validate
