// Large deflection of a cantilever, compared with the elastica: under a tip load and under its own weight.

#include <cmath>
#include <limits>

#include "host/lab/validate/reference.hpp"
#include "host/lab/validate/specimen.hpp"

namespace ligature::validate {
namespace {

/// Position of the tip at rest, relative to the clamp. The rod is clamped along +x, loaded along -y, and has free
/// length 1.
Vec3 tip(const Subject& subject, double tip_load, double weight) {
  auto scene = unit_thread(subject, 0.2, 7.0);
  if (!is_rod(scene)) {  // longer by half a segment, which the clamp holds
    scene.suture.length_m = (subject.nodes - 1) / (subject.nodes - 1.5);
    scene.suture.paper.node_mass_kg = segment_m(scene);
    scene.suture.paper.bend_damping = 0.02 / segment_m(scene);  // damps the high modes; does not affect the balance
    set_bending(scene, 1.0);
    lay(scene, [](double s) { return Vec3(s, 0, 0); });
  }
  clamp_start(scene);
  scene.world.loads.push_back({subject.nodes - 1, {0, -tip_load, 0}});
  if (weight > 0.0) weigh(scene, weight, 1);
  auto sim = build(scene);
  const bool still = settle(sim, no_hands(), 1e-6, 2000);
  if (!still) return Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  return sim.nodes_W().back() - Vec3(clamp_end_m(scene), 0, 0);
}

Findings compare(const Subject& subject, const char* table, const char* column, bool heavy) {
  const double tolerance = subject.nodes >= 200 ? 1e-3 : 5e-3;
  Findings all;
  for (const auto& row : reference_rows(table)) {
    const double load = number(row, column);
    const Vec3 p = heavy ? tip(subject, 0.0, load) : tip(subject, load, 0.0);
    const Vec3 truth(number(row, "tip_x_over_L"), -number(row, "tip_y_over_L"), 0.0);
    auto finding = absolute((heavy ? "wL3/EI = " : "PL2/EI = ") + row.at(column) + ": tip y/L", truth.y(), p.y(),
                            tolerance, "of L");
    finding.error = (p - truth).norm();  // distance of the tips, not only of their y
    all.push_back(finding);
  }
  return all;
}

}  // namespace

Findings elastica_tip_load(const Subject& subject) {  // reference: elliptic integrals, closed form
  return compare(subject, "01_elastica_tip_load.csv", "PL2_over_EI", false);
}

Findings elastica_heavy(const Subject& subject) {  // reference: shooting method, to 1e-9
  return compare(subject, "01_heavy_elastica.csv", "wL3_over_EI", true);
}

}  // namespace ligature::validate
