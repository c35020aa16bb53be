#include "firmware/app/drawn_knot.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "protocol/scene/polyline.hpp"

namespace ligature::app {
namespace {

using physics::Vec3;

constexpr double kTaut = 0.07;      // strain at which a knot counts as drawn tight: 5 N on a 3-0 nylon thread
constexpr double kLongest_s = 5.0;  // longest duration of drawing
constexpr double kFarthest = 1.3;   // largest distance of the ends, in thread lengths, if the thread never becomes taut
constexpr int kRestTicks = 100, kHoldTicks = 300;
// Length of the thread in the units of trefoil()'s coordinates; with 91 units, a quarter of the thread lies in the knot
constexpr double kUnits = 91.0;

/// Point of the standard trefoil knot at parameter t, with the axes y and z exchanged. loose_overhand() cuts the curve
/// open at its lowest point, t = pi.
scene::Vec trefoil(double t) {
  return {std::sin(t) + 2.0 * std::sin(2.0 * t), -std::sin(3.0 * t), std::cos(t) - 2.0 * std::cos(2.0 * t)};
}

double distance(const scene::Vec& a, const scene::Vec& b) { return std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]); }

}  // namespace

std::vector<scene::Vec> loose_overhand(const scene::Suture& suture, const scene::Vec& middle_W_m) {
  constexpr int kSteps = 600;
  constexpr double kOpen = 0.35;  // rad omitted on each side of t = pi, where the two tails begin
  const double unit_m = suture.length_m / kUnits;
  std::vector<scene::Vec> curve;
  for (int k = 0; k <= kSteps; ++k) {
    const auto p = trefoil(-M_PI + kOpen + (2.0 * M_PI - 2.0 * kOpen) * k / kSteps);
    curve.push_back({middle_W_m[0] + unit_m * p[0], middle_W_m[1] + unit_m * p[1], middle_W_m[2] + unit_m * p[2]});
  }
  double knotted_m = 0.0;
  for (std::size_t i = 1; i < curve.size(); ++i) knotted_m += distance(curve[i - 1], curve[i]);
  const double tail_m = 0.5 * (suture.length_m - knotted_m);
  const double side = curve.front()[0] < curve.back()[0] ? 1.0 : -1.0;
  const auto led_off = [&](scene::Vec from, double to) { return scene::Vec{from[0] + to * tail_m, from[1], from[2]}; };
  curve.insert(curve.begin(), led_off(curve.front(), -side));
  curve.push_back(led_off(curve.back(), side));
  return curve;
}

scene::Scene with_loose_knot(scene::Scene scene) {
  const bool has_own = !scene.suture.initial_polyline_m.empty() && scene.world.fixed.empty();
  scene.world.desk_height_m.reset();
  if (has_own) return scene;
  const scene::Vec middle =
      scene.world.fixed.empty() ? scene::Vec{0.0, 0.0, 1.0} : scene.world.fixed.front().position_m;
  scene.world.fixed.clear();
  scene.suture.initial = "overhand";
  const auto& s = scene.suture;
  scene.suture.initial_polyline_m = scene::lay_out(loose_overhand(s, middle), s.nodes, s.length_m / (s.nodes - 1));
  return scene;
}

scene::Scene no_longer_than(scene::Scene scene, int nodes) {
  if (scene.suture.nodes <= nodes) return scene;
  scene.suture.length_m *= static_cast<double>(nodes - 1) / (scene.suture.nodes - 1);
  scene.suture.nodes = nodes;
  scene.suture.initial_polyline_m.clear();  // with_loose_knot() makes a new start shape
  return scene;
}

DrawnKnot draw(physics::Simulation thread, const scene::Scene& scene, double speed_m_per_s, const Tick& tick) {
  std::array<physics::ToolInput, 2> tools{};
  tools[0].p_WT = thread.nodes_W().front(), tools[1].p_WT = thread.nodes_W().back();
  tools[0].grip = tools[1].grip = true;
  const Vec3 apart = tools[1].p_WT - tools[0].p_WT;
  const Vec3 way = apart.normalized();
  DrawnKnot result{speed_m_per_s, 0.0, 0.0, 0};
  const auto hold = [&](int ticks, double* lost) {
    tools[0].v_WT = tools[1].v_WT = Vec3::Zero();
    for (int k = 0; k < ticks; ++k) {
      tick(thread, tools);
      if (lost != nullptr) *lost += thread.diagnostics().time_lost / ticks;
    }
  };
  hold(kRestTicks, nullptr);

  const double most_m = kFarthest * scene.suture.length_m;
  const double step_m = speed_m_per_s * scene.time.tick_s;
  double lost = 0.0;
  for (int k = 0; k < static_cast<int>(kLongest_s / scene.time.tick_s); ++k) {
    tools[0].v_WT = -speed_m_per_s * way, tools[1].v_WT = speed_m_per_s * way;
    tools[0].p_WT -= step_m * way, tools[1].p_WT += step_m * way;
    tick(thread, tools);
    ++result.ticks;
    lost += thread.diagnostics().time_lost;
    const bool is_taut = thread.diagnostics().max_stretch > kTaut;
    if (is_taut || (tools[1].p_WT - tools[0].p_WT).norm() > most_m) break;
  }
  result.pull_lost = lost / std::max(1, result.ticks);
  hold(kHoldTicks, &result.hold_lost);
  return result;
}

}  // namespace ligature::app
