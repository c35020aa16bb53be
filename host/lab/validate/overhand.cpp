// A loose open overhand knot against the theory of elastic knots: without friction, and tightened and loosened with it.

#include "host/lab/validate/overhand.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include "host/lab/validate/reference.hpp"

namespace ligature::validate {
namespace {

constexpr double kB = 4e-7, kA_m = 1.5e-4;  // bending stiffness and radius of the suture

Vec3 lobes(double t) {
  return {std::sin(t) + 2.0 * std::sin(2.0 * t), std::cos(t) - 2.0 * std::cos(2.0 * t) + 3.0, -std::sin(3.0 * t)};
}

/// The suture with a knot whose excess length is 2 pi R, nodes where they are needed; drag calms it.
scene::Scene knotted(const Subject& subject, double R_m, double friction) {
  const double excess = 2.0 * std::numbers::pi * R_m;
  auto scene = real_thread(subject, 1.0, friction);
  scene.suture.length_m = 1.7 * excess;
  scene.suture.rod.spacing = scene::Spacing::kAdaptive;
  scene.suture.rod.accuracy = scene::Accuracy::kFine;
  lay_overhand(scene, excess / 26.3);
  set_drag(scene, 30.0);
  return scene;
}

/// The tension, N, of the row's knot while it is tightened (+1), loosened (-1) or at rest (0).
double tension_of(const Subject& subject, double a_over_R, double friction, int sense) {
  const double R = kA_m / a_over_R, target = 2.0 * std::numbers::pi * R;
  auto scene = knotted(subject, R, friction);
  auto sim = build(scene);
  EndPull pull(sim);
  const double dt = scene.time.tick_s, L = scene.suture.length_m;
  const auto go_to = [&](double excess, double speed) {  // then the mean over the way's last tenth of a millimetre
    double sum = 0.0, count = 0.0;
    for (int k = 0; k < 20000 && sim.diagnostics().finite; ++k) {
      const double now = L - pull.distance_m(), left = now - excess;
      if (std::abs(left) <= speed * dt) break;
      pull.tick(left > 0 ? speed : -speed, dt);
      if (std::abs(left) < 0.005 * target) sum += pull.tension_N(), count += 1.0;
    }
    return count > 0 ? sum / count : 0.0;
  };
  for (int k = 0; k < 200; ++k) pull.tick(0.0, dt);
  const double slow = 0.005;
  if (sense == 0) {
    go_to(target, 0.05);
    for (int k = 0; k < 1500; ++k) pull.tick(0.0, dt);
    return pull.tension_N();
  }
  go_to(target * (sense > 0 ? 1.08 : 0.92), 0.05);
  for (int k = 0; k < 300; ++k) pull.tick(0.0, dt);
  return go_to(target, slow);
}

Row row_of(double a_over_R, double mu) {
  for (const auto& row : reference_rows("07_elastic_knot_tension.csv")) {
    if (number(row, "n") == 1 && number(row, "a_over_R") == a_over_R && number(row, "mu") == mu) return row;
  }
  return {};
}

}  // namespace

void lay_overhand(scene::Scene& s, double unit_m) {
  constexpr double kPi = std::numbers::pi, kOver = 0.119;  // the ends pass each other by a third of a unit in z
  const double from = kPi - kOver, to = 3.0 * kPi + kOver;
  constexpr int kFine = 4000;
  std::vector<double> along(kFine + 1, 0.0);
  for (int k = 1; k <= kFine; ++k) {
    const auto at = [&](int j) { return lobes(from + (to - from) * j / kFine); };
    along[static_cast<std::size_t>(k)] = along[static_cast<std::size_t>(k - 1)] + unit_m * (at(k) - at(k - 1)).norm();
  }
  const double knot = along.back(), tail = 0.5 * (s.suture.length_m - knot);
  const Vec3 first = unit_m * lobes(from), last = unit_m * lobes(to);
  lay(s, [&](double at) -> Vec3 {
    if (at <= tail) return first - Vec3(tail - at, 0, 0);
    if (at >= tail + knot) return last + Vec3(at - tail - knot, 0, 0);
    const auto found = std::lower_bound(along.begin(), along.end(), at - tail);
    const double share = static_cast<double>(found - along.begin()) / kFine;
    return unit_m * lobes(from + (to - from) * share);
  });
}

double excess_m(const physics::Simulation& sim, double length_m) {
  return length_m - (sim.nodes_W().back() - sim.nodes_W().front()).norm();
}

EndPull::EndPull(physics::Simulation& sim) : sim_(sim), tools_(no_hands()) {
  tools_[0] = {sim.nodes_W().front(), Vec3::Zero(), true};
  tools_[1] = {sim.nodes_W().back(), Vec3::Zero(), true};
}

void EndPull::tick(double speed_m_per_s, double tick_s) {
  for (std::size_t h = 0; h < 2; ++h) {
    tools_[h].v_WT.x() = h == 0 ? -speed_m_per_s : speed_m_per_s;
    tools_[h].p_WT.x() += tick_s * tools_[h].v_WT.x();
  }
  sim_.tick(tools_);
}

double EndPull::tension_N() const {
  return 0.5 * (sim_.hand(physics::Hand::kLeft).f_W.x() - sim_.hand(physics::Hand::kRight).f_W.x());
}

Findings loose_overhand(const Subject& subject) {  // first order in sqrt(a / R); the leading order alone is 9 % off at 0.01
  Findings all;
  for (const double a_over_R : {0.01, 0.005}) {
    const auto row = row_of(a_over_R, 0.0);
    const double truth = number(row, "T_a2_over_B_frictionless_first_order(derived_here)");
    all.push_back(relative("a/R = " + row.at("a_over_R") + ": T a^2/B", truth,
                           tension_of(subject, a_over_R, 0.0, 0) * kA_m * kA_m / kB, 0.10));
  }
  return all;
}

Findings overhand_hysteresis(const Subject& subject) {  // half the loop's width: mu sigma (a / R)^(3/2)
  const auto row = row_of(0.01, 0.05);
  const double upper = number(row, "T_a2_over_B_tightening_upper"), lower = number(row, "T_a2_over_B_loosening_lower");
  const double scale = kA_m * kA_m / kB;
  const double up = tension_of(subject, 0.01, 0.05, 1) * scale, down = tension_of(subject, 0.01, 0.05, -1) * scale;
  return {relative("a/R = 0.01, mu = 0.05: half the width of the loop, T a^2/B", 0.5 * (upper - lower), 0.5 * (up - down),
                   0.20)};
}

}  // namespace ligature::validate
