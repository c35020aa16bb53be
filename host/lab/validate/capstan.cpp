// A thread slipping slowly round a peg: tension ratio against the polygon's and against the smooth cylinder's.

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <tuple>

#include "host/lab/validate/reference.hpp"
#include "host/lab/validate/specimen.hpp"

namespace ligature::validate {
namespace {

constexpr double kRadius_m = 0.02;  // of the thread's centre line on the peg
constexpr double kSpeed_m_per_s = 0.005;
constexpr double kPitch_m = 0.0024;  // of a whole turn: the thread must not lie on itself; lengthens the way by 0.02 %

/// T1 / T2 with `wrapped` segments on an arc of `angle_rad`: one end loaded with 1 N, the other drawn along, averaged
/// over one segment's length, because the polygon's corners come and go.
double tension_ratio(const Subject& subject, double mu, double angle_rad, int wrapped) {
  const double rise = angle_rad > 6.0 ? kPitch_m / (2.0 * std::numbers::pi) : 0.0;  // along the peg, per radian
  const double per_rad = std::hypot(kRadius_m, rise), arc = angle_rad * per_rad, l = arc / wrapped;
  auto scene = real_thread(subject, 1.0, mu);
  scene.suture.length_m = l * (subject.nodes - 1);
  set_bending(scene, 1e-11);
  set_stretch(scene, 1000.0);
  scene.hands.coupling_N_per_m = 2e4;
  scene.world.pegs.push_back({{0, -1, 0}, {0, 1, 0}, kRadius_m - scene.suture.radius_m});
  const double tail = 0.5 * (scene.suture.length_m - arc);
  const auto tangent = [&](double a) -> Vec3 {
    return Vec3(kRadius_m * std::sin(a), rise, kRadius_m * std::cos(a)) / per_rad;
  };
  const Vec3 up = tangent(0.0), pull = tangent(angle_rad);  // where the thread meets the peg, and leaves it
  lay(scene, [&](double s) -> Vec3 {
    const double a = std::clamp((s - tail) / per_rad, 0.0, angle_rad);
    const Vec3 on_peg(-kRadius_m * std::cos(a), rise * a, kRadius_m * std::sin(a));
    return on_peg + std::min(0.0, s - tail) * up + std::max(0.0, s - tail - arc) * pull;
  });
  scene.world.loads.push_back({0, {-up.x(), -up.y(), -up.z()}});
  auto sim = build(scene);
  Tools tools = no_hands();
  tools[1].grip = true;
  tools[1].p_WT = sim.nodes_W().back();
  tools[1].v_WT = kSpeed_m_per_s * pull;
  const double step = kSpeed_m_per_s * scene.time.tick_s;
  // The hand, the tail and what lies on the peg give first; twice that way and all of it slips.
  const double most_N = std::exp(mu * angle_rad), strain = most_N / scene.suture.rod.EA_N;
  const double gives = most_N / scene.hands.coupling_N_per_m + strain * (tail + per_rad / mu);
  const int counted = static_cast<int>(std::lround(l / step));
  const int ticks = 200 + static_cast<int>(2.0 * gives / step) + counted;
  double sum = 0.0;
  for (int k = 0; k < ticks; ++k) {
    tools[1].p_WT += step * pull;
    proceed(sim, tools);
    if (k >= ticks - counted) sum -= sim.hand(physics::Hand::kRight).f_W.dot(pull) / counted;
  }
  return sum;
}

/// The table's polygon touches the peg with its corners; our contacts lie in the middle of segments, and push and brake
/// both ends. Balance at a corner where two segments meet at 2 a, T and N growing by (1 + g) / (1 - g) a segment:
/// g (1 + s^2) + mu s g^2 = mu s, s = tan a. To second order it errs by -(2a)^2 / 6 of mu theta, the table by + / 12.
double by_segments(double mu, double angle_rad, int wrapped) {
  const double s = std::tan(0.5 * angle_rad / wrapped), b = 1.0 + s * s;
  const double g = 2.0 * mu * s / (b + std::sqrt(b * b + 4.0 * mu * mu * s * s));
  return std::pow((1.0 + g) / (1.0 - g), wrapped);
}

/// Measured once: both cases ask.
double measured_ratio(const Subject& subject, double mu, double angle_rad, int wrapped) {
  static std::map<std::tuple<std::optional<scene::Accuracy>, double, double, int>, double> known;
  const auto [at, is_new] = known.try_emplace({subject.accuracy, mu, angle_rad, wrapped});
  if (is_new) at->second = tension_ratio(subject, mu, angle_rad, wrapped);
  return at->second;
}

Findings compare(const Subject& subject, bool polygon) {
  const int wrapped = subject.nodes >= 200 ? 64 : 32;
  Findings all;
  for (const auto& row : reference_rows("05_capstan_polygonal.csv")) {
    const double mu = number(row, "mu"), degrees = number(row, "wrap_angle_deg");
    if (number(row, "N_contact_nodes") != wrapped) continue;
    const double angle = degrees * std::numbers::pi / 180.0;
    // In a whole turn of 32 segments the two polygons are up to 4 % apart, in half a turn 0.5 %.
    const double corners = degrees > 180.0 ? by_segments(mu, angle, wrapped) : number(row, "T1_over_T2");
    const double truth = polygon ? corners : std::exp(mu * angle);
    all.push_back(relative("mu = " + row.at("mu") + ", " + row.at("wrap_angle_deg") + " deg: T1/T2", truth,
                           measured_ratio(subject, mu, angle, wrapped), polygon ? 0.02 : 0.05));
  }
  return all;
}

}  // namespace

Findings capstan_polygonal(const Subject& subject) { return compare(subject, true); }
Findings capstan_exponential(const Subject& subject) { return compare(subject, false); }

}  // namespace ligature::validate
