#include "firmware/physics/paper/build.hpp"

#include <cmath>
#include <numbers>

#include "firmware/physics/paper/stretch_spring.hpp"

namespace ligature::physics {
namespace {

constexpr int kBruteUpTo = 600;  // nodes; for more, Sweep is cheaper (docs/physics.md, "Broad phases")

V3<double> to_v3(const scene::Vec& a) { return {a[0], a[1], a[2]}; }

/// Sets the constants of the paper's Table I, which apply to each node. If the scene has reference_nodes, they are
/// converted to its number of nodes (see build_thread()).
void set_constants(const scene::Scene& scene, ThreadModel& m) {
  const scene::PaperParameters& p = scene.suture.paper;
  // Ratio of the segment length to that with reference_nodes (`shorter`), and ratio of the node masses
  const double shorter = p.reference_nodes ? (*p.reference_nodes - 1.0) / (m.nodes - 1.0) : 1.0;
  const double fewer = p.reference_nodes ? *p.reference_nodes / static_cast<double>(m.nodes) : 1.0;
  m.mass_kg = p.node_mass_kg * fewer;
  m.stretch_N = p.stretch_N;
  if (scene.suture.model == scene::Model::kPaper5 && p.quadratic_stretch == scene::QuadraticStretch::kStiff)
    m.stretch_N *= kStiffQuadratic;
  m.stretch_N_s_per_m = p.stretch_damping / shorter;
  m.bend_N_m = p.bend / shorter;
  m.bend_N_m_s = p.bend_damping / shorter;
  m.swivel_N_s = p.swivel_damping / (shorter * shorter);
  m.drag_per_s = p.air_drag_per_s;
  m.step_s = scene.time.tick_s / scene.time.substeps;
}

void lay_out(const scene::Scene& scene, BuiltThread& t) {
  const ThreadModel& m = t.model;
  const auto& line = scene.suture.initial_polyline_m;
  V3<double> top{0.0, 0.0, scene.suture.length_m};
  int at = 0;
  if (!scene.world.fixed.empty()) {
    const scene::FixedNode& f = scene.world.fixed.front();
    top = to_v3(f.position_m), at = f.node < 0 ? m.nodes - 1 : f.node;
  }
  for (int i = 0; i < m.nodes; ++i) {
    if (line.empty())
      t.initial.p.put(i, top + V3<double>{0.0, 0.0, (at - i) * m.rest_m});
    else
      t.initial.p.put(i, to_v3(line[static_cast<std::size_t>(i)]));
  }
}

void pin(BuiltThread& t, int node, const V3<double>& p) {
  if (node < 0 || node >= t.model.nodes) return;
  t.initial.p.put(node, p);
  t.model.inverse_mass_per_kg[node] = 0.0;
  t.model.free[node] = 0.0;
}

/// Fixes the scene's nodes. A clamp also fixes the node's neighbours, so that the thread leaves it towards higher node
/// numbers in the given direction.
void fix_nodes(const scene::Scene& scene, BuiltThread& t) {
  for (const scene::FixedNode& f : scene.world.fixed) {
    const int node = f.node < 0 ? t.model.nodes - 1 : f.node;
    const V3<double> p = to_v3(f.position_m);
    pin(t, node, p);
    if (!f.direction) continue;
    const V3<double> d = to_v3(*f.direction);
    const V3<double> step = (t.model.rest_m / norm(d)) * d;
    pin(t, node + 1, p + step);
    if (node > 0) pin(t, node - 1, p - step);
  }
}

}  // namespace

std::variant<BuiltThread, std::string> build_thread(const scene::Scene& scene) {
  const scene::Suture& s = scene.suture;
  if (s.model == scene::Model::kRod) return "model 'rod' is none of the paper's: rod::rod_of() builds it";
  if (s.nodes < 2) return "a thread has at least 2 nodes, found " + std::to_string(s.nodes);
  if (!(s.length_m > 0.0 && s.radius_m > 0.0 && s.paper.node_mass_kg > 0.0))
    return std::string("length, radius and mass must be positive");
  if (!(scene.time.tick_s > 0.0) || scene.time.substeps < 1)
    return std::string("the tick must be positive, with at least one substep");
  if (!s.initial_polyline_m.empty() && s.initial_polyline_m.size() != static_cast<std::size_t>(s.nodes))
    return "the initial shape has " + std::to_string(s.initial_polyline_m.size()) + " points for " +
           std::to_string(s.nodes) + " nodes";

  BuiltThread t;
  ThreadModel& m = t.model;
  m.nodes = s.nodes;
  m.rest_m = s.length_m / (s.nodes - 1);
  m.radius_m = s.radius_m;
  set_constants(scene, m);
  m.inverse_mass_per_kg = m.free = m.segment = Lane(s.nodes);
  for (int i = 0; i < s.nodes; ++i) m.inverse_mass_per_kg[i] = 1.0 / m.mass_kg, m.free[i] = 1.0;
  for (int i = 0; i < s.nodes - 1; ++i) m.segment[i] = 1.0;
  t.initial.p = t.initial.v = Lane3(s.nodes);
  lay_out(scene, t);
  fix_nodes(scene, t);
  extend_last_node(t.initial.p, s.nodes);
  return t;
}

ContactSettings build_contact(const scene::Scene& scene, const ThreadModel& m) {
  ContactSettings c;
  c.slip = scene.contact.friction;
  c.stick = scene.contact.static_friction.value_or(c.slip);
  // A thread of radius r cannot touch itself within an arc of length pi r; segments closer along the thread are not
  // tested
  c.skip = 1 + static_cast<int>(std::ceil(std::numbers::pi * m.radius_m / m.rest_m - 1e-9));
  if (c.skip < 2) c.skip = 2;
  c.desk_m = scene.world.desk_height_m;
  c.broad_phase = scene.contact.broad_phase;
  if (c.broad_phase == scene::BroadPhase::kAuto)
    c.broad_phase = m.nodes <= kBruteUpTo ? scene::BroadPhase::kBrute : scene::BroadPhase::kSweep;
  return c;
}

}  // namespace ligature::physics
