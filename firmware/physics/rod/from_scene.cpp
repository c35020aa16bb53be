#include "firmware/physics/rod/from_scene.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/physics/rod/jaws.hpp"

namespace ligature::physics::rod {
namespace {

Vec vec(const scene::Vec& a) noexcept { return make(a[0], a[1], a[2]); }

Material material_of(const scene::Scene& scene) noexcept {
  const auto& r = scene.suture.rod;
  Material m;
  m.length_m = scene.suture.length_m;
  m.radius_m = scene.suture.radius_m;
  m.density_kg_per_m = r.density_kg_per_m;
  m.EA_N = r.EA_N;
  m.EI_N_m2 = r.EI_N_m2;
  m.GJ_N_m2 = r.GJ_N_m2;
  m.bend_tau_s = r.damping_s;
  m.stretch_tau_s = r.stretch_damping_s;
  m.drag_per_s = r.air_drag_per_s;
  m.friction = scene.contact.friction;
  return m;
}

// A point of the initial shape: the polyline of the scene, node k at material coordinate k L / (nodes - 1), or straight
// down.
Vec initial_point(const scene::Scene& scene, double s) noexcept {
  const auto& line = scene.suture.initial_polyline_m;
  if (line.size() < 2) {
    Vec top{};
    for (const auto& f : scene.world.fixed) {
      if (f.node == 0) top = vec(f.position_m);
    }
    return top - make(0, 0, s);
  }
  const double at = s / scene.suture.length_m * static_cast<double>(line.size() - 1);
  const auto k = std::min(static_cast<std::size_t>(std::max(at, 0.0)), line.size() - 2);
  const double share = at - static_cast<double>(k);
  return (1.0 - share) * vec(line[k]) + share * vec(line[k + 1]);
}

}  // namespace

Numerics numerics_of(const scene::Scene& scene) noexcept {
  Numerics n;
  n.tick_s = scene.time.tick_s;
  switch (scene.suture.rod.accuracy) {
    case scene::Accuracy::kFast:
      n.substeps = 10;
      n.max_substeps = 16;
      n.settled_m_per_s = 1e-3;
      break;
    case scene::Accuracy::kBalanced:
      break;
    case scene::Accuracy::kFine:
      n.substeps = n.max_substeps = 40;
      n.settled_m_per_s = 1e-5;
      n.max_passes = n.passes_per_substep = 40;
      break;
  }
  n.substeps = std::max(n.substeps, scene.time.substeps);
  n.max_substeps = std::max(n.max_substeps, n.substeps);
  return n;
}

Parts parts_of(const scene::Scene& scene) noexcept {
  Parts p;
  int roll = 0;  // ends that can hold the thread's roll: clamps, and both hands
  for (const auto& f : scene.world.fixed) roll += f.direction.has_value();
  p.twist = scene.suture.rod.GJ_N_m2 > 0.0 && roll + 2 >= 2;
  p.contact = scene.contact.solver != scene::ContactSolver::kNone;
  p.world =
      p.contact && (scene.world.desk_height_m.has_value() || !scene.world.pegs.empty() || scene.world.grippers_collide);
  p.friction = p.contact && scene.contact.friction > 0.0;
  p.adaptive = scene.suture.rod.spacing == scene::Spacing::kAdaptive;
  return p;
}

std::variant<Rod, std::string> rod_of(const scene::Scene& scene) {
  const int n = scene.suture.nodes;
  if (n < 4) return "suture.nodes: found " + std::to_string(n) + ", the rod model needs 4 or more";
  if (scene.contact.solver == scene::ContactSolver::kPaper)
    return "contact.solver: found \"paper\", the rod model has \"none\" and \"implicit\"";
  if (scene.contact.static_friction && *scene.contact.static_friction != scene.contact.friction)
    return "contact.static_friction: the rod model has one coefficient for stick and slip; leave it out";
  const int bodies = static_cast<int>(scene.world.pegs.size()) + 2;
  Rod rod(material_of(scene), numerics_of(scene), parts_of(scene), n, bodies);
  State& state = rod.state();
  rod.gravity = vec(scene.world.gravity_m_per_s2);
  if (scene.world.desk_height_m) rod.has_floor = true, rod.floor_m = *scene.world.desk_height_m;
  rod.floor_friction = scene.contact.friction;
  for (const auto& peg : scene.world.pegs) {
    rod.bodies.push_back({vec(peg.from_m), vec(peg.to_m), peg.radius_m, Vec{}, scene.contact.friction});
  }
  for (std::size_t i = 0; i < state.x.size(); ++i) state.x[i] = initial_point(scene, state.mesh.s[i]);
  const auto mesh_node = [&](int node) {  // scenes number nodes as if equally spaced
    const int k = node < 0 ? n - 1 : node;
    const double s = scene.suture.length_m * k / (n - 1);
    const auto& all = state.mesh.s;
    const auto next = std::lower_bound(all.begin(), all.end(), s - 1e-12 * scene.suture.length_m);
    auto i = static_cast<int>(next - all.begin());
    if (i > 0 && (i == n || s - all[static_cast<std::size_t>(i - 1)] < all[static_cast<std::size_t>(i)] - s)) --i;
    return i;
  };
  for (const auto& load : scene.world.loads)
    state.load[static_cast<std::size_t>(mesh_node(load.node))] += vec(load.force_N);
  const int of_hands = scene.hands.pinch_width_m > 0.0 ? 2 * Jaws::kMost : 2;
  if (static_cast<int>(scene.world.fixed.size()) + of_hands > kMaxHolds) {
    return "world.fixed: found " + std::to_string(scene.world.fixed.size()) + " nodes, the rod model takes " +
           std::to_string(kMaxHolds - of_hands);
  }
  for (const auto& f : scene.world.fixed) {
    const int node = mesh_node(f.node);
    if (f.direction) {
      rod.clamp(node, vec(f.position_m), vec(*f.direction));
    } else {
      rod.support(node, vec(f.position_m));
    }
    state.x[static_cast<std::size_t>(node)] = vec(f.position_m);
  }
  rod.moved();
  return rod;
}

}  // namespace ligature::physics::rod
