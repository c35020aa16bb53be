#include "firmware/physics/rod/from_scene.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/physics/rod/grip/jaws.hpp"

namespace ligature::physics::rod {
namespace {

Vec vec(const scene::Vec& a) noexcept { return make(a[0], a[1], a[2]); }

Material material_of(const scene::Scene& scene) {
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
  m.static_friction = scene.contact.static_friction.value_or(0.0);
  m.born_curvature_per_m = r.rest_curvature_per_m;
  m.born_twist_per_m = r.rest_twist_per_m;
  m.yield_curvature_per_m = r.yield_strain.value_or(0.0) / m.radius_m;  // strain at the surface = radius x curvature
  m.set_fraction = r.set_fraction;
  for (const auto& region : r.stiffness_profile) m.regions.push_back({region.from_m, region.to_m, region.EI_N_m2});
  return m;
}

// Places the thread straight down from the fixed position of node 0 or, if node 0 is not fixed, from the origin.
void hang(const scene::Scene& scene, State& state) noexcept {
  Vec top{};
  for (const auto& f : scene.world.fixed) {
    if (f.node == 0) top = vec(f.position_m);
  }
  for (std::size_t i = 0; i < state.x.size(); ++i) state.x[i] = top - make(0, 0, state.mesh.s[i]);
}

// Curvature of the scene's polyline, point by point, 1/m.
std::vector<double> curvature_of(const std::vector<scene::Vec>& line) {
  std::vector<double> curvature(line.size(), 0.0);
  for (std::size_t k = 1; k + 1 < line.size(); ++k) {
    const Vec a = vec(line[k]) - vec(line[k - 1]), b = vec(line[k + 1]) - vec(line[k]);
    const double both = norm(a) + norm(b);
    if (both > 0.0) curvature[k] = 2.0 * std::atan2(norm(cross(a, b)), dot(a, b)) / both;
  }
  return curvature;
}

/// Does the scene give one point per node? Then the points are used as they are, even if segments are stretched.
bool is_node_by_node(const scene::Scene& scene) noexcept {
  return static_cast<int>(scene.suture.initial_polyline_m.size()) == scene.suture.nodes &&
         scene.suture.rod.spacing == scene::Spacing::kUniform;
}

// Places nodes along the scene's polyline, each one rest length from the last in a straight line, so that no segment is
// stretched. With rest lengths measured along the line, segments in bends would be 1 % too short, a large compression
// at EA = 71 N.
void lay_along(const std::vector<scene::Vec>& line, State& state) noexcept {
  state.x[0] = vec(line[0]);
  std::size_t k = 1;  // the search goes on in the line's segment k - 1 .. k, at parameter u
  double u = 0.0;
  const Vec onward = vec(line.back()) - vec(line[line.size() - 2]);
  for (std::size_t i = 1; i < state.x.size(); ++i) {
    const double rest = state.mesh.s[i] - state.mesh.s[i - 1];
    const Vec c = state.x[i - 1];
    for (;; ++k, u = 0.0) {  // larger root of |a + u d - c| = rest; the last segment is extended without end
      const bool last = k + 1 >= line.size();
      const Vec a = last ? vec(line.back()) - onward : vec(line[k - 1]), d = last ? onward : vec(line[k]) - a;
      const double A = dot(d, d), B = dot(a - c, d), D = B * B - A * (dot(a - c, a - c) - rest * rest);
      const double root = D < 0.0 || A == 0.0 ? -1.0 : (std::sqrt(D) - B) / A;
      if (!last && (root < u || root > 1.0)) continue;
      state.x[i] = root >= u ? a + root * d : c + rest / norm(onward) * onward;
      u = root >= u ? root : u;
      break;
    }
  }
}

/// Reason why the rod model cannot simulate the scene, or an empty string.
std::string objection_to(const scene::Scene& scene) {
  if (scene.suture.nodes < 4)
    return "suture.nodes: found " + std::to_string(scene.suture.nodes) + ", the rod model needs 4 or more";
  if (scene.contact.solver == scene::ContactSolver::kPaper)
    return "contact.solver: found \"paper\", the rod model has \"none\" and \"implicit\"";
  if (scene.suture.rod.GJ_N_m2 == 0.0) {  // without twist there are no material frames
    if (scene.suture.rod.rest_curvature_per_m != 0.0)
      return "suture.rest_curvature_per_m: needs suture.GJ_N_m2 above 0";
    if (scene.suture.rod.rest_twist_per_m != 0.0) return "suture.rest_twist_per_m: needs suture.GJ_N_m2 above 0";
    if (scene.suture.rod.yield_strain) return "suture.yield_strain: needs suture.GJ_N_m2 above 0";
    if (scene.contact.turns_thread) return "contact.turns_thread: needs suture.GJ_N_m2 above 0";
  }
  const int of_hands = scene.hands.pinch_width_m > 0.0 ? 2 * Jaws::kMost : 2;
  if (static_cast<int>(scene.world.fixed.size()) + of_hands > kMaxHolds)
    return "world.fixed: found " + std::to_string(scene.world.fixed.size()) + " nodes, the rod model takes " +
           std::to_string(kMaxHolds - of_hands);
  const auto& line = scene.suture.initial_polyline_m;
  if (line.size() >= 2 && !is_node_by_node(scene) && !(norm(vec(line.back()) - vec(line[line.size() - 2])) > 0.0))
    return "suture.initial: found its last two points in one place, the rod model needs a direction there";
  return {};
}

/// Reason why the rod cannot start in its present shape, or an empty string. If the thread's axis lay below the desk,
/// contact would throw it up at hundreds of metres per second.
std::string objection_to_start(const Rod& rod) {
  const auto& x = rod.state().x;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (x[i][2] < rod.floor_m)
      return "suture.initial: found node " + std::to_string(i) +
             " below world.desk_height_m, the rod model needs a start above the desk";
  }
  return {};
}

}  // namespace

Numerics numerics_of(const scene::Scene& scene) noexcept {
  Numerics n;
  n.tick_s = scene.time.tick_s;
  switch (scene.suture.rod.accuracy) {
    case scene::Accuracy::kFast:
      n.substeps = 10;
      n.max_substeps = 16;
      n.work = 3'260'000;  // 3.6 M instructions with 154 nodes: a little more than half of what `balanced` has
      break;
    case scene::Accuracy::kBalanced:
      break;
    case scene::Accuracy::kFine:
      n.substeps = n.max_substeps = 40;
      n.settled_m_per_s = 1e-5;
      n.work = 40'000'000;
      break;
  }
  n.given_work = scene.suture.rod.work_instructions;
  n.substeps = std::max(n.substeps, scene.time.substeps);
  n.max_substeps = std::max(n.max_substeps, n.substeps);
  return n;
}

Parts parts_of(const scene::Scene& scene) noexcept {
  Parts p;
  p.twist = scene.suture.rod.GJ_N_m2 > 0.0;
  p.contact = scene.contact.solver != scene::ContactSolver::kNone;
  p.world =
      p.contact && (scene.world.desk_height_m.has_value() || !scene.world.pegs.empty() || scene.world.grippers_collide);
  p.friction = p.contact && std::max(scene.contact.friction, scene.contact.static_friction.value_or(0.0)) > 0.0;
  const auto turns = [](const scene::Peg& peg) { return peg.surface_m_per_s != 0.0; };
  p.drum = p.world && p.friction && std::any_of(scene.world.pegs.begin(), scene.world.pegs.end(), turns);
  p.turning = p.twist && p.friction && scene.contact.turns_thread;
  p.roll = p.twist &&
           (p.turning || scene.suture.rod.rest_curvature_per_m != 0.0 || scene.suture.rod.rest_twist_per_m != 0.0);
  p.set = p.twist && material_of(scene).sets();
  p.adaptive = scene.suture.rod.spacing == scene::Spacing::kAdaptive;
  return p;
}

std::variant<Rod, std::string> rod_of(const scene::Scene& scene) {
  if (auto why = objection_to(scene); !why.empty()) return why;
  const int n = scene.suture.nodes;
  const int bodies = static_cast<int>(scene.world.pegs.size()) + 2;
  Rod rod(material_of(scene), numerics_of(scene), parts_of(scene), n, bodies);
  State& state = rod.state();
  rod.gravity = vec(scene.world.gravity_m_per_s2);
  if (scene.world.desk_height_m) rod.has_floor = true, rod.floor_m = *scene.world.desk_height_m;
  rod.floor_friction = scene.contact.friction;
  for (const auto& peg : scene.world.pegs) {
    const Vec axis = vec(peg.to_m) - vec(peg.from_m);
    const Vec spin = peg.surface_m_per_s != 0.0 ? (peg.surface_m_per_s / norm(axis)) * axis : Vec{};
    rod.bodies.push_back({vec(peg.from_m), vec(peg.to_m), peg.radius_m, Vec{}, scene.contact.friction, spin});
  }
  const auto& line = scene.suture.initial_polyline_m;
  if (line.size() < 2) {
    hang(scene, state);
  } else if (is_node_by_node(scene)) {
    for (std::size_t i = 0; i < line.size(); ++i) state.x[i] = vec(line[i]);
  } else {
    rod.spread(curvature_of(line));
    lay_along(line, state);
  }
  const auto mesh_node = [&](int node) {  // scenes number nodes as if equally spaced
    const int k = node < 0 ? n - 1 : node;
    const double s = scene.suture.length_m * k / (n - 1);
    const auto& all = state.mesh.s;
    const auto next = std::lower_bound(all.begin(), all.end(), s - 1e-12 * scene.suture.length_m);
    auto i = static_cast<int>(next - all.begin());
    if (i > 0 && (i == n || s - all[i - 1] < all[i] - s)) --i;
    return i;
  };
  for (const auto& load : scene.world.loads) state.load[mesh_node(load.node)] += vec(load.force_N);
  for (const auto& f : scene.world.fixed) {
    const int node = mesh_node(f.node);
    if (f.direction) {
      rod.clamp(node, vec(f.position_m), vec(*f.direction));
    } else {
      rod.support(node, vec(f.position_m));
    }
    state.x[node] = vec(f.position_m);
  }
  rod.moved();
  if (parts_of(scene).world && rod.has_floor) {
    if (auto why = objection_to_start(rod); !why.empty()) return why;
  }
  return rod;
}

}  // namespace ligature::physics::rod
