// A thread whose ends are brought together and turned winds up into a ply: two strands round each other, with an end
// loop. Without friction.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "firmware/physics/rod/from_scene.hpp"
#include "host/lab/published/case.hpp"
#include "host/lab/published/writhe.hpp"
#include "host/lab/validate/rods.hpp"
#include "host/lab/validate/specimen.hpp"

namespace ligature::published {
namespace {

using physics::rod::Rod;
using physics::rod::Twist;
using physics::rod::Vec;

constexpr double kPi = std::numbers::pi;
constexpr double kTurns = 20.0, kSlack = 0.3;   // of dismech-newton's plectoneme.py
constexpr double kLength_h = 322.6;             // length over thread radius, as there: 0.5 m over 1.55 mm
constexpr double kTwist_over_bend = 1.0 / 1.5;  // GJ / EI for Poisson's ratio 0.5, as there
constexpr double kStretch_factor = 10.0;        // of the suture's EA: the theory's thread does not stretch

/// The theory at ply angle a and radius R; lengths in R, forces in B / R^2.
double force(double a) { return std::pow(std::sin(a), 3) * (std::cos(a) * std::tan(2.0 * a) - 0.5 * std::sin(a)); }
double moment(double a) { return 2.0 / std::sin(2.0 * a) * (0.5 * std::pow(std::sin(a), 4) + force(a)); }

Rod straight(const Subject& subject, int nodes) {
  auto scene = validate::real_thread(subject.rod(nodes), 1.0, 0.0);
  scene.suture.length_m = kLength_h * scene.suture.radius_m;
  scene.suture.rod.GJ_N_m2 = kTwist_over_bend * scene.suture.rod.EI_N_m2;
  validate::set_stretch(scene, kStretch_factor * scene.suture.rod.EA_N);
  validate::lay(scene, [](double s) { return validate::Vec3(s, 0, 0); });
  scene.world.fixed.push_back({0, {0, 0, 0}, scene::Vec{1, 0, 0}});
  scene.world.fixed.push_back({-1, {scene.suture.length_m, 0, 0}, scene::Vec{1, 0, 0}});
  auto made = physics::rod::rod_of(scene);
  if (auto* why = std::get_if<std::string>(&made)) throw std::runtime_error(*why);
  return std::get<Rod>(std::move(made));
}

/// Turns one end and brings it nearer, both evenly during `wind` ticks, then waits for `rest` ticks.
void wind_up(Rod& rod, double turns, int wind, int rest) {
  auto& end = rod.state().holds[1];
  const double step = kSlack * rod.material().length_m / wind;
  // A sideways push, without which the straight thread would not buckle.
  rod.state().load[static_cast<std::size_t>(rod.state().nodes() / 2)] = physics::rod::make(0, 0, 1e-5);
  std::array<Vec, physics::rod::kMaxHolds> goals{};
  for (std::size_t h = 0; h < 2; ++h) goals[h] = rod.state().holds[h].target;
  for (int k = 0; k < wind + rest; ++k) {
    if (k < wind) {
      goals[1] -= physics::rod::make(step, 0, 0);
      Twist::roll(end, 2.0 * kPi * turns / wind);
    }
    validate::proceed(rod, goals);
  }
}

/// What the ply looks like; lengths in m.
struct Shape {
  double angle_rad = std::nan(""), radius_m = std::nan("");
};

Vec nearest(const std::vector<Vec>& x, std::size_t first, Vec p) {
  Vec best{};
  double least = 1e300;
  for (std::size_t k = first; k + 1 < x.size(); ++k) {
    const Vec e = x[k + 1] - x[k];
    const Vec q = x[k] + std::clamp(dot(p - x[k], e) / dot(e, e), 0.0, 1.0) * e;
    if (norm(q - p) < least) least = norm(q - p), best = q;
  }
  return best;
}

/// Measures the ply, the piece where the two strands touch, over its inner 60 %. The ply angle follows from how fast
/// the line between the strands turns along the axis. `h`: radius of the thread.
Shape shape_of(const std::vector<Vec>& x, double h) {
  const auto off_axis = [](Vec a, Vec b) { return std::hypot(a[1], a[2]) < std::hypot(b[1], b[2]); };
  const auto tip = static_cast<std::size_t>(std::max_element(x.begin(), x.end(), off_axis) - x.begin());
  const auto across = [&](std::size_t k) { return Vec(nearest(x, tip, x[k]) - x[k]); };
  std::vector<std::size_t> touching;
  for (std::size_t k = 2; k < tip; ++k) {
    if (norm(across(k)) < 2.2 * h) touching.push_back(k);
  }
  if (touching.size() < 10) return {};
  const std::size_t first = touching[touching.size() / 5], last = touching[touching.size() * 4 / 5];
  const Vec from = x[first] + 0.5 * across(first), to = x[last] + 0.5 * across(last);
  const Vec axis = (1.0 / norm(to - from)) * (to - from);
  double turned = 0.0, apart = 0.0;
  for (std::size_t k = first; k < last; ++k) {
    const Vec a = across(k), b = across(k + 1), flat_a = a - dot(a, axis) * axis, flat_b = b - dot(b, axis) * axis;
    turned += std::atan2(dot(axis, cross(flat_a, flat_b)), dot(flat_a, flat_b));
    apart += norm(a) / static_cast<double>(last - first);
  }
  return {std::atan(0.5 * apart * std::abs(turned) / norm(to - from)), 0.5 * apart};
}

/// Linking number: twist plus writhe of the thread, prolonged along the axis of its ends.
double linking_number(const Rod& rod) {
  std::vector<Vec> line = rod.state().x;
  const double far = 1e3 * rod.material().length_m;
  line.insert(line.begin(), line.front() - physics::rod::make(far, 0, 0));
  line.push_back(line.back() + physics::rod::make(far, 0, 0));
  return rod.twist().turn_rad(0) / (2.0 * kPi) + writhe(line);
}

}  // namespace

Result ply(const Subject& subject) {
  Result result;
  for (const double turns : subject.quick ? std::vector{kTurns} : std::vector{14.0, 17.0, kTurns}) {
    Rod rod = straight(subject, subject.quick ? 400 : 600);
    wind_up(rod, turns, 5000, 3000);
    const auto& m = rod.material();
    const Shape shape = shape_of(rod.state().x, m.radius_m);
    const double a = shape.angle_rad, R = shape.radius_m, unit_N = m.EI_N_m2 / (R * R), degrees = a * 180.0 / kPi;
    const double F = rod.forces().edge.front()[0] / unit_N, M = std::abs(rod.twist().moment_Nm(0)) / (unit_N * R);
    const std::string at = std::to_string(std::lround(turns)) + " turns: ";
    result.findings.push_back(validate::relative(at + "tension of the ends, F R^2 / B", force(a), F, 0.03));
    result.findings.push_back(validate::relative(at + "moment of the ends, M R / B", moment(a), M, 0.03));
    result.findings.push_back(
        validate::relative(at + "radius of the ply over the thread's", 1.0, R / m.radius_m, 0.03));
    result.findings.push_back(
        validate::absolute(at + "linking number", turns, std::abs(linking_number(rod)), 0.05, ""));
    result.findings.push_back(reported(at + "angle of the ply (deg)", degrees, ""));
    result.points.push_back({"F R^2 / B", degrees, force(a), F});
    result.points.push_back({"M R / B", degrees, moment(a), M});
  }
  for (int step = 0; step < 10; ++step) {
    const double degrees = 10.0 + 2.0 * step;
    const double a = degrees * kPi / 180.0;
    result.points.push_back({"F R^2 / B", degrees, force(a), std::nan("")});
    result.points.push_back({"M R / B", degrees, moment(a), std::nan("")});
  }
  return result;
}

}  // namespace ligature::published
