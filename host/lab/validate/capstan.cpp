// Capstan test: a thread slips slowly round a peg; the tension ratio is compared with the solutions for a polygon and
// for a smooth cylinder.

#include "host/lab/validate/capstan.hpp"

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

constexpr double kRadius_m = 0.02;  // radius of the thread's centreline on the peg
constexpr double kSpeed_m_per_s = 0.005;
// axial advance per turn, so that the thread does not lie on itself; lengthens the path by 0.02 %
constexpr double kPitch_m = 0.0024;

/// Closed form of the tension ratio T1 / T2 for the simulated polygon. In the simulation contacts are at the middle of
/// segments and act on both end nodes; the polygon of the reference table touches the peg with its corners. The formula
/// is the balance of forces at a corner between two segments that meet at an angle 2a, with friction coefficient mu.
/// From one segment to the next, tension and normal force grow by the factor (1 + g) / (1 - g), where g solves g (1 +
/// s^2) + mu s g^2 = mu s, s = tan a. To second order, the relative error of the exponent mu theta (theta: the whole
/// angle) is -(2a)^2 / 6 here and +(2a)^2 / 12 in the table.
double by_segments(double mu, double angle_rad, int wrapped) {
  const double s = std::tan(0.5 * angle_rad / wrapped), b = 1.0 + s * s;
  const double g = 2.0 * mu * s / (b + std::sqrt(b * b + 4.0 * mu * mu * s * s));
  return std::pow((1.0 + g) / (1.0 - g), wrapped);
}

/// tension_ratio(), cached because two cases need the same measurement.
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
    // The reference table is for a polygon that touches the peg with its corners; here the middles of the segments
    // touch. With 32 segments T1 / T2 of the two differ by 0.5 % for half a turn and by up to 4 % for a whole turn;
    // therefore more than half a turn is compared with by_segments().
    const double corners = degrees > 180.0 ? by_segments(mu, angle, wrapped) : number(row, "T1_over_T2");
    const double truth = polygon ? corners : std::exp(mu * angle);
    all.push_back(relative("mu = " + row.at("mu") + ", " + row.at("wrap_angle_deg") + " deg: T1/T2", truth,
                           measured_ratio(subject, mu, angle, wrapped), polygon ? 0.02 : 0.05));
  }
  return all;
}

}  // namespace

double tension_ratio(const Subject& subject, double mu, double angle_rad, int wrapped, double drum_m_per_s) {
  const double rise = angle_rad > 6.0 ? kPitch_m / (2.0 * std::numbers::pi) : 0.0;  // advance along the peg per radian
  const double per_rad = std::hypot(kRadius_m, rise), arc = angle_rad * per_rad, l = arc / wrapped;
  auto scene = real_thread(subject, 1.0, mu);
  scene.suture.length_m = l * (subject.nodes - 1);
  set_bending(scene, 1e-11);
  set_stretch(scene, 1000.0);
  scene.hands.coupling_N_per_m = 2e4;
  // From the load the thread goes round the bar's axis (+y) in the right-handed sense.
  scene.world.pegs.push_back({{0, -1, 0}, {0, 1, 0}, kRadius_m - scene.suture.radius_m, -drum_m_per_s});
  const double tail = 0.5 * (scene.suture.length_m - arc);
  const auto tangent = [&](double a) -> Vec3 {
    return Vec3(kRadius_m * std::sin(a), rise, kRadius_m * std::cos(a)) / per_rad;
  };
  // tangents where the thread meets the peg and where it leaves it
  const Vec3 up = tangent(0.0), pull = tangent(angle_rad);
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
  const double hand_m_per_s = drum_m_per_s == 0.0 ? kSpeed_m_per_s : 0.0;
  tools[1].v_WT = hand_m_per_s * pull;
  const double step = kSpeed_m_per_s * scene.time.tick_s;  // of the slip, or about that much
  // `gives`: distance by which the hand's spring, the free tail and the wrapped thread stretch before the whole thread
  // slips. Averaging begins after twice this distance.
  const double most_N = std::exp(mu * angle_rad), strain = most_N / scene.suture.rod.EA_N;
  const double gives = most_N / scene.hands.coupling_N_per_m + strain * (tail + per_rad / mu);
  const int counted = static_cast<int>(std::lround(l / step));
  const int ticks = 200 + static_cast<int>(2.0 * gives / step) + counted;
  double sum = 0.0;
  for (int k = 0; k < ticks; ++k) {
    tools[1].p_WT += scene.time.tick_s * tools[1].v_WT;
    proceed(sim, tools);
    if (k >= ticks - counted) sum -= sim.hand(physics::Hand::kRight).f_W.dot(pull) / counted;
  }
  return sum;
}

Findings capstan_polygonal(const Subject& subject) { return compare(subject, true); }
Findings capstan_exponential(const Subject& subject) { return compare(subject, false); }

}  // namespace ligature::validate
