// Hanging threads without bending: catenary, elastic string.

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/lab/validate/reference.hpp"
#include "host/lab/validate/specimen.hpp"

namespace ligature::validate {

Findings catenary(const Subject& subject) {  // closed form; two hands hold the ends and feel what the supports carry
  Findings all;
  for (const auto& row : reference_rows("02_catenary_inextensible.csv")) {
    const double span = number(row, "span_over_S");
    if (span < 0.35 || span > 0.95) continue;
    auto scene = unit_thread(subject, 0.1, 4.0);
    set_bending(scene, is_rod(scene) ? 1e-7 : 0.0);
    scene.hands.coupling_N_per_m = 1e5;
    scene.hands.coupling_N_s_per_m = is_rod(scene) ? 0.0 : 1.0;
    scene.suture.paper.stretch_damping = 1.0;
    const double depth = std::sqrt(1.0 - span * span);
    lay(scene, [&](double s) { return Vec3(span * s, 0, -depth * std::min(s, 1.0 - s)); });  // a V to start from
    weigh(scene, 1.0, 2);
    auto sim = build(scene);
    Tools tools = no_hands();
    tools[0] = {Vec3(0, 0, 0), Vec3::Zero(), true};
    tools[1] = {Vec3(span, 0, 0), Vec3::Zero(), true};
    double sag = std::numeric_limits<double>::quiet_NaN(), tension = sag;
    if (settle(sim, tools, 1e-5, 4000)) {
      sag = 0.0;
      for (const auto& p : sim.nodes_W()) sag = std::max(sag, -p.z());
      tension = sim.hand(physics::Hand::kLeft).f_W.norm();
    }
    const auto at = "span/S = " + row.at("span_over_S");
    all.push_back(relative(at + ": sag/S", number(row, "sag_over_S"), sag, 2e-3));
    all.push_back(relative(at + ": end tension/wS", number(row, "Tend_over_wS"), tension, 5e-3));
  }
  return all;
}

Findings elastic_string(const Subject& subject) {  // closed form; lumped masses are exact to O(1 / N^2)
  Findings all;
  for (const auto& row : reference_rows("02_hanging_elastic_string.csv")) {
    const double softness = number(row, "wL_over_EA"), weight = number(row, "tip_weight_over_wL");
    if (number(row, "s_over_L") < 1.0 || softness > 0.2 || softness < 1e-3) continue;
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
    double extension = std::numeric_limits<double>::quiet_NaN();
    if (settle(sim, no_hands(), 1e-8, 4000)) extension = -sim.nodes_W().back().z() - 1.0;
    all.push_back(
        relative("wL/EA = " + row.at("wL_over_EA") + ", tip " + row.at("tip_weight_over_wL") + " wL: extension/L",
                 number(row, "position_over_L") - 1.0, extension, 5e-3));
  }
  return all;
}

}  // namespace ligature::validate
