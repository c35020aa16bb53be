// A loose open overhand knot, compared with the theory of elastic knots: at rest without friction, and tightened and
// loosened with friction.

#include "host/lab/validate/overhand.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

#include "firmware/physics/rod/rod_simulation.hpp"
#include "host/lab/validate/reference.hpp"

namespace ligature::validate {
namespace {

using physics::rod::RodSimulation;

constexpr double kB = 4e-7, kA_m = 1.5e-4;  // the suture's bending stiffness and radius

/// A thread of the suture's radius with another bending stiffness, laid as an overhand knot with air drag. The loop's
/// excess length (thread length less the distance of the ends) is about 2 pi R.
scene::Scene knotted(const Subject& subject, double R_m, double EI_N_m2, double friction) {
  auto scene = real_thread(subject, 1.0, friction);
  scene.suture.length_m = 1.3 * 2.0 * std::numbers::pi * R_m;
  scene.suture.rod.spacing = scene::Spacing::kAdaptive;
  set_bending(scene, EI_N_m2);
  lay_overhand(scene, R_m);
  set_drag(scene, EI_N_m2 > kB ? 10.0 : 30.0);
  return scene;
}

/// Tension T of a knot held at rest without friction, as T a^2/B (a: thread radius, B: bending stiffness).
double resting_tension(const Subject& subject, double a_over_R) {
  auto scene = knotted(subject, kA_m / a_over_R, kB, 0.0);
  auto sim = build(scene);
  EndPull pull(sim);
  for (int k = 0; k < 1500; ++k) pull.tick(0.0, scene.time.tick_s);
  return pull.tension_N() * kA_m * kA_m / kB;
}

/// Node positions concentrated where the strands touch: segments of length h there, growing by a quarter of the
/// distance from there. h is chosen such that all n nodes are used.
std::vector<double> gathered(int n, const OverhandCurve& curve, double reach_m) {
  const auto wanted = [&](double s, double h) {
    double off = curve.length_m;
    for (const double c : curve.crossings_m()) off = std::min(off, std::max(0.0, std::abs(s - c) - reach_m));
    return h + 0.25 * off;
  };
  constexpr int kCells = 20000;
  const double cell = curve.length_m / kCells;
  const auto count = [&](double h) {  // number of segments for a given h
    double sum = 0.0;
    for (int k = 0; k < kCells; ++k) sum += cell / wanted((k + 0.5) * cell, h);
    return sum;
  };
  double low = 1e-6 * curve.length_m, high = curve.length_m;
  for (int k = 0; k < 60; ++k) (count(std::sqrt(low * high)) > n - 1 ? low : high) = std::sqrt(low * high);
  std::vector<double> s{0.0};
  const double share = count(high) / (n - 1);
  double sum = 0.0;
  for (int k = 0; k < kCells && static_cast<int>(s.size()) < n - 1; ++k) {
    sum += cell / wanted((k + 0.5) * cell, high);
    if (sum >= share * static_cast<double>(s.size())) s.push_back((k + 1.0) * cell);
  }
  s.push_back(curve.length_m);
  return s;
}

/// The scene's thread with its nodes concentrated where the two strands wind round each other (the braid), laid along
/// the curve of a loose overhand knot.
RodSimulation gathered_knot(const scene::Scene& scene, double R_m, double travel_m) {
  auto made = RodSimulation::make(scene);
  if (auto* why = std::get_if<std::string>(&made)) throw std::runtime_error(*why);
  auto sim = std::get<RodSimulation>(std::move(made));
  auto& state = sim.rod().state();
  const double L = scene.suture.length_m, a = scene.suture.radius_m;
  const OverhandCurve natural(L, a, R_m, 0.0);
  state.mesh.s = gathered(scene.suture.nodes, natural, natural.half_m + travel_m);
  const OverhandCurve curve(L, a, R_m, [&] {
    double least = L;
    for (std::size_t j = 0; j + 1 < state.mesh.s.size(); ++j)
      least = std::min(least, state.mesh.s[j + 1] - state.mesh.s[j]);
    return least;
  }());
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    const Vec3 p = curve.at(state.mesh.s[i]);
    state.x[i] = physics::rod::make(p.x(), p.y(), p.z());
  }
  sim.rod().moved();
  return sim;
}

/// Tension T of a knot that is slowly tightened (sense +1) or loosened (-1), measured while its size passes the given
/// a / R; as T a^2/B. Averaged over one segment's length, because polygon corners pass the contact. The bending
/// stiffness B is larger than the suture's, which makes drag negligible.
double sliding_tension(const Subject& subject, double a_over_R, double friction, int sense) {
  const double EI = 100.0 * kB, R = kA_m / a_over_R, target = 2.0 * std::numbers::pi * R, speed = 0.005;
  auto scene = knotted(subject, R, EI, friction);
  scene.suture.rod.spacing = scene::Spacing::kUniform;  // until gathered_knot() places the nodes
  const double travel = 0.04 * target;
  auto sim = gathered_knot(scene, R, travel);
  EndPull pull(sim);
  const double dt = scene.time.tick_s, L = scene.suture.length_m;
  // moves the hands until the excess length is `excess`; returns the mean tension during this motion
  const auto go_to = [&](double excess, double at_speed) {
    double sum = 0.0, count = 0.0;
    for (int k = 0; k < 100000 && sim.diagnostics().finite; ++k) {
      const double left = L - pull.distance_m() - excess;
      if (std::abs(left) <= 1.01 * at_speed * dt) break;
      pull.tick(left > 0 ? at_speed : -at_speed, dt);
      sum += pull.tension_N(), count += 1.0;
    }
    return count > 0 ? sum / count : 0.0;
  };
  for (int k = 0; k < 200; ++k) pull.tick(0.0, dt);
  const double window = segment_m(scene);
  go_to(target + sense * (travel + 0.5 * window), 0.05);
  for (int k = 0; k < 300; ++k) pull.tick(0.0, dt);
  go_to(target + sense * 0.5 * window, speed);
  return go_to(target - sense * 0.5 * window, speed) * kA_m * kA_m / EI;
}

Row row_of(double a_over_R, double mu) {
  for (const auto& row : reference_rows("07_elastic_knot_tension.csv")) {
    if (number(row, "n") == 1 && number(row, "a_over_R") == a_over_R && number(row, "mu") == mu) return row;
  }
  return {};
}

}  // namespace

OverhandCurve::OverhandCurve(double length, double radius, double loop, double finest_m)
    : length_m(length), radius_m(radius), loop_m(loop) {
  half_m = std::max(2.5 * std::sqrt(2.0 * radius_m * loop_m), 3.5 * finest_m);
}

std::array<double, 2> OverhandCurve::crossings_m() const {
  const double round = 2.0 * std::numbers::pi * loop_m, tail = 0.5 * (length_m - round);
  return {tail, tail + round};
}

Vec3 OverhandCurve::at(double along) const {
  constexpr double kPi = std::numbers::pi;
  const double a = radius_m, round = 2.0 * kPi * loop_m, natural = 2.5 * std::sqrt(2.0 * a * loop_m), half = half_m;
  const double aside = half > natural ? 2.0 * a : 1.2 * a;
  const double bow = (round - 4.0 * half) / (2.0 * kPi);  // radius of the loop's two half circles
  // Path of the loop, from the middle of its foot: foot, half circle, top, half circle, foot.
  const auto loop = [&](double at) -> Vec3 {
    if (at < half) return {at, 0, 0};
    at -= half;
    if (at < kPi * bow) return {half + bow * std::sin(at / bow), bow * (1.0 - std::cos(at / bow)), 0};
    at -= kPi * bow;
    if (at < 2.0 * half) return {half - at, 2.0 * bow, 0};
    at -= 2.0 * half;
    if (at < kPi * bow) return {-half - bow * std::sin(at / bow), bow * (1.0 + std::cos(at / bow)), 0};
    return {at - kPi * bow - half, 0, 0};
  };
  // Each strand makes three half turns along the foot.
  const auto turn = [&](double at) { return 3.0 * kPi * std::clamp(0.5 * (at / half + 1.0), 0.0, 1.0); };
  const auto [first_m, second_m] = crossings_m();
  const double first = along - first_m, second = along - second_m;
  const double phase = first < 0.5 * round ? kPi + turn(first) : 2.0 * kPi + turn(second);
  const Vec3 centre = first < 0.0 ? Vec3(first, 0, 0) : second < 0.0 ? loop(first) : Vec3(second, 0, 0);
  return centre + aside * Vec3(0, std::cos(phase), std::sin(phase));
}

void lay_overhand(scene::Scene& s, double loop_m) {
  const OverhandCurve curve(s.suture.length_m, s.suture.radius_m, loop_m, segment_m(s));
  lay(s, [&](double along) { return curve.at(along); });
}

// reference: expansion to first order in sqrt(a / R); its leading term alone errs by 9 % at a / R = 0.01
Findings loose_overhand(const Subject& subject) {
  Findings all;
  for (const double a_over_R : {0.01, 0.005}) {
    const auto row = row_of(a_over_R, 0.0);
    all.push_back(relative("a/R = " + row.at("a_over_R") + ": T a^2/B",
                           number(row, "T_a2_over_B_frictionless_first_order(derived_here)"),
                           resting_tension(subject, a_over_R), 0.10));
  }
  return all;
}

// Reference for half the width of the hysteresis loop of T a^2/B between tightening and loosening:
// mu sigma (a / R)^(3/2), sigma a constant of the reference table. This is the leading order; the next one adds a
// fraction of about 5 sqrt(a / R) (15 % at a / R = 0.001, 48 % at 0.01; docs/accuracy.md). Therefore the test uses
// 0.001 with a tolerance of 20 %.
Findings overhand_hysteresis(const Subject& subject) {
  const double a_over_R = 0.001, mu = 0.02;
  double sigma = 0.0;
  for (const auto& row : reference_rows("07_elastic_knot_constants.csv")) {
    if (number(row, "n(unknotting_number;1=trefoil,2=cinquefoil)") == 1)
      sigma = number(row, "sigma_radius_based=J/(2sqrt2)");
  }
  const double up = sliding_tension(subject, a_over_R, mu, 1), down = sliding_tension(subject, a_over_R, mu, -1);
  return {relative("a/R = 0.001, mu = 0.02: half the width of the loop, T a^2/B", mu * sigma * std::pow(a_over_R, 1.5),
                   0.5 * (up - down), 0.20)};
}

}  // namespace ligature::validate
