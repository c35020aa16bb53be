// The curve of an overhand knot, and a thread laid along it with its nodes where the strands touch.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

#include "host/lab/validate/overhand.hpp"

namespace ligature::validate {
namespace {

/// Node positions concentrated where the strands touch. Segments have the length h there; elsewhere they are longer by
/// `growth` times the distance from the touching strands. h is chosen such that all n nodes are used.
std::vector<double> gathered(int n, const OverhandCurve& curve, double reach_m, double growth) {
  const auto wanted = [&](double s, double h) {
    double off = curve.length_m;
    for (const double c : curve.crossings_m()) off = std::min(off, std::max(0.0, std::abs(s - c) - reach_m));
    return h + growth * off;
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

}  // namespace

OverhandCurve::OverhandCurve(double length, double radius, double loop, double finest_m)
    : length_m(length), radius_m(radius), loop_m(loop), half_m(2.5 * std::sqrt(2.0 * radius * loop)) {
  suit(finest_m);
}

void OverhandCurve::suit(double finest_m) {
  if (half_m > 3.5 * finest_m) return;
  half_m = 3.5 * finest_m;
  aside_m = 2.0 * radius_m;
}

std::array<double, 2> OverhandCurve::crossings_m() const {
  const double round = 2.0 * std::numbers::pi * loop_m, tail = 0.5 * (length_m - round);
  return {tail, tail + round};
}

Vec3 OverhandCurve::at(double along) const {
  constexpr double kPi = std::numbers::pi;
  const double round = 2.0 * kPi * loop_m, half = half_m;
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
  // At the base of the loop the two strands wind about each other by an odd number of half windings, so that the end
  // passes through the loop.
  const auto turn = [&](double at) {
    return (2.0 * turns + 1.0) * kPi * std::clamp(0.5 * (at / half + 1.0), 0.0, 1.0);
  };
  const auto [first_m, second_m] = crossings_m();
  const double first = along - first_m, second = along - second_m;
  const double phase = first < 0.5 * round ? kPi + turn(first) : 2.0 * kPi + turn(second);
  const Vec3 centre = first < 0.0 ? Vec3(first, 0, 0) : second < 0.0 ? loop(first) : Vec3(second, 0, 0);
  return centre + aside_m * Vec3(0, std::cos(phase), std::sin(phase));
}

void lay_overhand(scene::Scene& s, double loop_m) {
  const OverhandCurve curve(s.suture.length_m, s.suture.radius_m, loop_m, segment_m(s));
  lay(s, [&](double along) { return curve.at(along); });
}

scene::Scene knotted(const Subject& subject, double loop_m, double EI_N_m2, double friction) {
  auto scene = real_thread(subject, 1.0, friction);
  scene.suture.length_m = 1.3 * 2.0 * std::numbers::pi * loop_m;
  scene.suture.rod.spacing = scene::Spacing::kAdaptive;
  set_bending(scene, EI_N_m2);
  lay_overhand(scene, loop_m);
  set_drag(scene, EI_N_m2 > kOverhandB_N_m2 ? 10.0 : 30.0);
  return scene;
}

physics::rod::RodSimulation gathered_knot(scene::Scene scene, OverhandCurve curve, double travel_m, double growth) {
  scene.suture.rod.spacing = scene::Spacing::kUniform;
  auto made = physics::rod::RodSimulation::make(scene);
  if (auto* why = std::get_if<std::string>(&made)) throw std::runtime_error(*why);
  auto sim = std::get<physics::rod::RodSimulation>(std::move(made));
  auto& state = sim.rod().state();
  auto& s = state.mesh.s;
  s = gathered(scene.suture.nodes, curve, curve.half_m + travel_m, growth);
  double least = curve.length_m;
  for (std::size_t j = 0; j + 1 < s.size(); ++j) least = std::min(least, s[j + 1] - s[j]);
  curve.suit(least);
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    const Vec3 p = curve.at(s[i]);
    state.x[i] = physics::rod::make(p.x(), p.y(), p.z());
  }
  sim.rod().moved();
  return sim;
}

}  // namespace ligature::validate
