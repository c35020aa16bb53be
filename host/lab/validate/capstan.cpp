// A thread slipping slowly round a peg: tension ratio against the polygon's and against the smooth cylinder's.

#include <cmath>
#include <numbers>

#include "host/lab/validate/reference.hpp"
#include "host/lab/validate/specimen.hpp"

namespace ligature::validate {
namespace {

constexpr double kRadius_m = 0.02;  // of the thread's centre line on the peg
constexpr double kSpeed_m_per_s = 0.005;

/// T1 / T2 with `wrapped` segments on an arc of `angle_rad`: one end loaded with 1 N, the other drawn along, averaged
/// over one segment's length, because the polygon's corners come and go.
double tension_ratio(const Subject& subject, double mu, double angle_rad, int wrapped) {
  const double arc = angle_rad * kRadius_m, l = arc / wrapped;
  auto scene = real_thread(subject, 1.0, mu);
  scene.suture.length_m = l * (subject.nodes - 1);
  set_bending(scene, 1e-11);
  set_stretch(scene, 1000.0);
  scene.hands.coupling_N_per_m = 2e4;  // its give is taken up before the counting starts
  scene.world.pegs.push_back({{0, -1, 0}, {0, 1, 0}, kRadius_m - scene.suture.radius_m});
  const double tail = 0.5 * (scene.suture.length_m - arc);
  const Vec3 pull(std::sin(angle_rad), 0, std::cos(angle_rad));  // tangent where the thread leaves the peg
  lay(scene, [&](double s) -> Vec3 {                             // up one side, round, away
    const double a = std::min((s - tail) / kRadius_m, angle_rad);
    if (s < tail) return {-kRadius_m, 0, s - tail};
    return Vec3(-kRadius_m * std::cos(a), 0, kRadius_m * std::sin(a)) + std::max(0.0, s - tail - arc) * pull;
  });
  scene.world.loads.push_back({0, {0, 0, -1.0}});
  auto sim = build(scene);
  Tools tools = no_hands();
  tools[1].grip = true;
  tools[1].p_WT = sim.nodes_W().back();
  tools[1].v_WT = kSpeed_m_per_s * pull;
  const double step = kSpeed_m_per_s * scene.time.tick_s;
  const int counted = static_cast<int>(std::lround(l / step)), ticks = 600 + counted;
  double sum = 0.0;
  for (int k = 0; k < ticks; ++k) {
    tools[1].p_WT += step * pull;
    sim.tick(tools);
    if (k >= ticks - counted) sum -= sim.hand(physics::Hand::kRight).f_W.dot(pull) / counted;
  }
  return sum;
}

Findings compare(const Subject& subject, bool polygon) {
  const int wrapped = subject.nodes >= 200 ? 64 : 32;
  Findings all;
  for (const auto& row : reference_rows("05_capstan_polygonal.csv")) {
    const double mu = number(row, "mu"), degrees = number(row, "wrap_angle_deg");
    if (number(row, "N_contact_nodes") != wrapped || degrees > 180.0 || mu == 0.2) continue;
    const double angle = degrees * std::numbers::pi / 180.0;
    const double truth = polygon ? number(row, "T1_over_T2") : std::exp(mu * angle);
    all.push_back(relative("mu = " + row.at("mu") + ", " + row.at("wrap_angle_deg") + " deg: T1/T2", truth,
                           tension_ratio(subject, mu, angle, wrapped), polygon ? 0.02 : 0.05));
  }
  return all;
}

}  // namespace

Findings capstan_polygonal(const Subject& subject) { return compare(subject, true); }
Findings capstan_exponential(const Subject& subject) { return compare(subject, false); }

}  // namespace ligature::validate
