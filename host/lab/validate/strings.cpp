// Hanging threads without bending stiffness: catenary and elastic string.

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "host/lab/validate/reference.hpp"
#include "host/lab/validate/specimen.hpp"

namespace ligature::validate {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Depth of the lowest point of a smooth line through equally spaced nodes, from a cubic through four nodes. The lowest
/// node alone may be half a segment beside it: 0.27 % of the sag for 50 nodes and supports 0.2 thread lengths apart.
double sag_of(std::span<const Vec3> x) {
  const auto z = [&](std::size_t i) { return -x[i].z(); };
  std::size_t at = 0;  // first of the four deepest nodes
  for (std::size_t i = 0; i + 3 < x.size(); ++i) {
    if (std::min(z(i), z(i + 3)) > std::min(z(at), z(at + 3))) at = i;
  }
  const double d1 = z(at + 1) - z(at), d2 = z(at + 2) - 2.0 * z(at + 1) + z(at),
               d3 = z(at + 3) - 3.0 * z(at + 2) + 3.0 * z(at + 1) - z(at);
  double sag = 0.0;
  for (int k = 0; k <= 3000; ++k) {
    const double u = 1e-3 * k;
    sag = std::max(sag, z(at) + u * (d1 + 0.5 * (u - 1.0) * (d2 + (u - 2.0) / 3.0 * d3)));
  }
  return sag;
}

/// Mean strain of a hanging thread of length 1 and weight 1 at a horizontal tension H. The rest length is reduced by
/// this strain, so that the thread is 1 long when it hangs, as the inextensible thread of the reference table: at a
/// span of 0.999 a strain of 1e-5 would change the sag by 0.5 %.
double mean_strain(const scene::Scene& scene, double H) {
  const double tension = 0.5 * std::hypot(H, 0.5) + H * H * std::asinh(0.5 / H), EA = scene.suture.rod.EA_N;
  return scene.suture.model == scene::Model::kPaper5 ? std::sqrt(tension / EA) : tension / EA;
}

}  // namespace

// reference: closed form; two hands hold the ends and measure the supports' forces
Findings catenary(const Subject& subject) {
  Findings all;
  for (const auto& row : reference_rows("02_catenary_inextensible.csv")) {
    const double span = number(row, "span_over_S"), depth = std::sqrt(1.0 - span * span);
    auto scene = unit_thread(subject, 0.1, 4.0);
    set_bending(scene, is_rod(scene) ? 1e-7 : 0.0);
    // paper-5: the force law uses stretch_N itself, not 100 times its value
    scene.suture.paper.quadratic_stretch = scene::QuadraticStretch::kPrinted;
    scene.suture.length_m = 1.0 - mean_strain(scene, number(row, "H_over_wS"));
    // stiffness of the hands' springs; in paper models limited by the stability of explicit steps
    const double K = is_rod(scene) ? scene.suture.rod.EA_N / segment_m(scene) : 1e5;
    scene.hands.coupling_N_per_m = K;
    scene.hands.coupling_N_s_per_m = is_rod(scene) ? 0.0 : 1.0;
    scene.suture.paper.stretch_damping = 1.0;
    const double L = scene.suture.length_m;
    lay(scene, [&](double s) { return Vec3(span * s / L, 0, -depth * std::min(s, L - s) / L); });  // start shape: a V
    weigh(scene, 1.0 / L, 2);
    if (scene.suture.model == scene::Model::kPaper5) {  // stiffness grows with strain: needs more substeps
      const double slope =
          2.0 * std::sqrt(scene.suture.paper.stretch_N * number(row, "Tend_over_wS")) / segment_m(scene);
      scene.time.substeps =
          static_cast<int>(2.0 * scene.time.tick_s * std::sqrt(slope / scene.suture.paper.node_mass_kg));
    }
    auto sim = build(scene);
    Tools tools = no_hands();
    // elongation of the hands' springs; each hand is placed further out by this length
    const double give = number(row, "H_over_wS") / K, lift = 0.5 / K;
    tools[0] = {Vec3(-give, 0, lift), Vec3::Zero(), true};
    tools[1] = {Vec3(span + give, 0, lift), Vec3::Zero(), true};
    const bool still = settle(sim, tools, 1e-5, 4000);
    const double tension = still ? sim.hand(physics::Hand::kLeft).f_W.norm() : kNan;
    const auto at = "span/S = " + row.at("span_over_S");
    all.push_back(relative(at + ": sag/S", number(row, "sag_over_S"), still ? sag_of(sim.nodes_W()) : kNan, 2e-3));
    all.push_back(relative(at + ": end tension/wS", number(row, "Tend_over_wS"), tension, 5e-3));
  }
  return all;
}

namespace {

/// Node positions at rest of a hanging string of length 1 and weight 1 with the load `weight` at its end; `softness` is
/// 1 / EA. Empty when the string does not come to rest.
std::vector<Vec3> hung(const Subject& subject, double softness, double weight) {
  auto scene = unit_thread(subject, 0.2, 4.0);
  set_bending(scene, 0.0);
  set_stretch(scene, 1.0 / softness);
  scene.suture.rod.stretch_damping_s = 0.1;
  scene.suture.paper.stretch_damping = 0.1 / softness / segment_m(scene);
  lay(scene, [](double s) { return Vec3(0, 0, -s); });
  scene.world.fixed.push_back({0, {0, 0, 0}, std::nullopt});
  scene.world.loads.push_back({subject.nodes - 1, {0, 0, -weight}});
  weigh(scene, 1.0, 2);
  auto sim = build(scene);
  if (!settle(sim, no_hands(), 1e-8, 4000)) return {};
  return {sim.nodes_W().begin(), sim.nodes_W().end()};
}

}  // namespace

Findings elastic_string(const Subject& subject) {  // reference: closed form; lumped masses give an error of O(1 / N^2)
  Findings all;
  std::map<std::pair<double, double>, std::vector<Vec3>> hangs;
  for (const auto& row : reference_rows("02_hanging_elastic_string.csv")) {
    const std::pair key(number(row, "wL_over_EA"), number(row, "tip_weight_over_wL"));
    if (!hangs.contains(key)) hangs[key] = hung(subject, key.first, key.second);
    const auto& x = hangs[key];
    const double s = number(row, "s_over_L"), at = s * (subject.nodes - 1);
    const auto i = std::min(static_cast<std::size_t>(at), static_cast<std::size_t>(subject.nodes - 2));
    const double share = at - static_cast<double>(i);
    const double z = x.empty() ? kNan : (1.0 - share) * x[i].z() + share * x[i + 1].z();
    all.push_back(relative("wL/EA = " + row.at("wL_over_EA") + ", tip " + row.at("tip_weight_over_wL") +
                               " wL, s = " + row.at("s_over_L") + " L: way down/L",
                           number(row, "position_over_L") - s, -z - s, 5e-3));
  }
  return all;
}

}  // namespace ligature::validate
