#include "host/lab/published/sliding_knot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "host/knot/recognise.hpp"
#include "host/lab/validate/overhand.hpp"

namespace ligature::published {
namespace {

using physics::Vec3;
using Nodes = std::span<const Vec3>;
using validate::EndPull;

constexpr double kPi = std::numbers::pi;
constexpr double kStiffness = 100.0;  // bending stiffness over the suture's: makes drag and hand springs negligible
constexpr double kGrowth = 0.05;      // of the segments in the loop: its curvature is measured
constexpr double kSpeed_m_per_s = 0.005, kSetUpSpeed_m_per_s = 0.05;

/// The point where a strand of the braid, nodes first .. last, crosses the plane x = at.
Vec3 crossing(Nodes nodes, std::size_t first, std::size_t last, double at) {
  for (std::size_t k = first; k < last; ++k) {
    const double x0 = nodes[k].x(), x1 = nodes[k + 1].x();
    if (x0 <= at && at < x1) return nodes[k] + (at - x0) / (x1 - x0) * (nodes[k + 1] - nodes[k]);
  }
  return Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
}

/// Curvature at node k, 1/m.
double curvature(Nodes nodes, std::size_t k) {
  const Vec3 a = nodes[k] - nodes[k - 1], b = nodes[k + 1] - nodes[k];
  return 2.0 * std::atan2(a.cross(b).norm(), a.dot(b)) / (a.norm() + b.norm());
}

/// Straight line y(x) by least squares: its slope and its value at x = 0.
struct Line {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  void add(double x, double y) { n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y; }
  [[nodiscard]] double slope() const { return (n * sxy - sx * sy) / (n * sxx - sx * sx); }
  [[nodiscard]] double at_zero() const { return (sy - slope() * sx) / n; }
};

/// What the shape of the knot tells; h: the thread's radius. The braid lies along x.
void measure_shape(Nodes nodes, double h, DrawnKnot& knot) {
  const std::size_t middle = static_cast<std::size_t>(
      std::max_element(nodes.begin(), nodes.end(), [](const Vec3& a, const Vec3& b) { return a.y() < b.y(); }) -
      nodes.begin());
  // The braid is where the strand before the loop's top touches the strand after it. The search for its ends begins in
  // its middle.
  const double step = 0.25 * h;
  const auto apart = [&](double x) {
    return Vec3(crossing(nodes, middle, nodes.size() - 1, x) - crossing(nodes, 0, middle, x));
  };
  double ends[2] = {0.0, 0.0};
  for (int side = 0; side < 2; ++side) {
    const double to = side == 0 ? -step : step;
    while (apart(ends[side] + to).norm() < 2.1 * h) ends[side] += to;
  }
  const double length = ends[1] - ends[0];
  Line phase;
  double turned = 0.0, before = 0.0, distance = 0.0;
  double x = ends[0] + 0.2 * length;
  while (x < ends[1] - 0.2 * length) {
    const Vec3 d = apart(x);
    const double angle = std::atan2(d.z(), d.y());
    turned += phase.n == 0 ? 0.0 : std::remainder(angle - before, 2.0 * kPi);
    before = angle;
    phase.add(x, turned);
    distance += d.norm();
    x += step;
  }
  knot.wave_number = std::abs(phase.slope()) * h;
  knot.contact_length = length / h;
  knot.clearance = distance / phase.n / h - 2.0;
  // The loop: the thread between the right end of the braid and its left end.
  std::size_t first = 0, last = nodes.size() - 1;
  while (first < middle && nodes[first].x() < ends[1]) ++first;
  while (last > middle && nodes[last].x() > ends[0]) --last;
  double loop = 0.0;
  for (std::size_t k = first; k < last; ++k) loop += (nodes[k + 1] - nodes[k]).norm();
  Line leaving, arriving;
  double along = 0.0;
  for (std::size_t k = first + 1; k < last; ++k) {
    along += (nodes[k] - nodes[k - 1]).norm();
    const double bend = curvature(nodes, k), to_end = std::min(along, loop - along);
    if (to_end > 0.02 * loop && to_end < 0.12 * loop)
      (along < 0.5 * loop ? leaving : arriving).add(to_end * to_end, bend);  // the curvature is largest at the exit
    knot.peak_curvature = std::max(knot.peak_curvature, bend * h);
    if (to_end > 0.25 * loop) knot.top_curvature = std::max(knot.top_curvature, bend * h);
  }
  knot.exit_curvature = 0.5 * h * (leaving.at_zero() + arriving.at_zero());
}

/// Whether the knot is the torus knot T(2, 2n + 1), n = `turns`. The recognition never names knots of nine crossings;
/// it only lists candidates. So a list with this knot as its only candidate counts, too.
bool is_the_knot(Nodes nodes, int turns) {
  std::vector<std::array<double, 3>> points;
  for (const auto& p : nodes) points.push_back({p.x(), p.y(), p.z()});
  const std::string name = std::to_string(2 * turns + 1) + "_1";
  const auto found = knot::recognise(points, false);
  return found.type == name || found.candidates == std::vector{name};
}

}  // namespace

DrawnKnot draw_knot(const Subject& subject, const KnotPlan& plan) {
  const double EI = kStiffness * validate::kOverhandB_N_m2;
  const validate::Subject rod = subject.rod(plan.nodes);
  const double h = validate::real_thread(rod, 1.0, plan.friction).suture.radius_m, excess = plan.excess_h * h;
  const double travel = 0.06 * excess, window = 0.02 * excess;
  auto scene = validate::knotted(rod, (excess + travel + window) / (2.0 * kPi), EI, plan.friction);
  scene.suture.length_m += plan.braid_h * h;
  const double dt = scene.time.tick_s, L = scene.suture.length_m;
  validate::OverhandCurve curve(L, h, (excess + travel + window) / (2.0 * kPi), 0.0);
  curve.turns = plan.turns;
  if (plan.braid_h > 0.0) curve.half_m = 0.5 * plan.braid_h * h;
  validate::lay(scene, [&](double along) { return curve.at(along); });  // the hands begin at its ends
  auto sim = validate::gathered_knot(scene, curve, travel, kGrowth);
  EndPull pull(sim);
  // Draws until the excess length is `to`; returns the mean tension.
  const auto draw_to = [&](double to, double speed) {
    double sum = 0.0, count = 0.0;
    for (int k = 0; k < 100000 && sim.diagnostics().finite && L - pull.distance_m() > to; ++k) {
      pull.tick(speed, dt);
      sum += pull.tension_N(), count += 1.0;
    }
    return sum / count;
  };
  for (int k = 0; k < 200; ++k) pull.tick(0.0, dt);
  draw_to(excess + 2.0 * window, kSetUpSpeed_m_per_s);
  draw_to(excess + window, kSpeed_m_per_s);
  const double first = draw_to(excess, kSpeed_m_per_s);
  DrawnKnot knot;
  measure_shape(sim.nodes_W(), h, knot);
  const double second = draw_to(excess - window, kSpeed_m_per_s);
  knot.tension = 0.5 * (first + second) * h * h / EI;
  knot.change = second / first - 1.0;
  if (!is_the_knot(sim.nodes_W(), plan.turns)) knot.tension = std::numeric_limits<double>::quiet_NaN();
  return knot;
}

}  // namespace ligature::published
