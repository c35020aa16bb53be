// Compares the rod model, with the paper's parameters, with the model paper-4: shapes at rest, and tied knots.

#include "host/lab/validate/paper_shapes.hpp"

#include <numbers>
#include <vector>

#include "host/knot/recognise.hpp"
#include "host/lab/validate/reference.hpp"
#include "host/lab/validate/specimen.hpp"
#include "protocol/scene/gripper_script.hpp"

namespace ligature::validate {
namespace {

using Shape = std::vector<Vec3>;

Shape at_rest(scene::Scene s) {
  auto& drag = is_rod(s) ? s.suture.rod.air_drag_per_s : s.suture.paper.air_drag_per_s;
  drag = 3.0;  // shortens the time to rest; does not affect the balance
  auto sim = build(s);
  settle(sim, no_hands(), 2e-4, 20000);
  return {sim.nodes_W().begin(), sim.nodes_W().end()};
}

/// Largest distance between corresponding nodes of two shapes.
double apart(const Shape& a, const Shape& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, (a[i] - b[i]).norm());
  return most;
}

scene::FixedNode fixed(int node, double x, double z) { return {node, {x, 0, z}, std::nullopt}; }

struct Pose {
  const char* name;
  void (*prepare)(scene::Scene&);
};

constexpr Pose kPoses[] = {
    {"hanging from the frame", [](scene::Scene&) {}},
    {"between two supports 2 m apart",
     [](scene::Scene& s) {
       s.world.fixed = {fixed(0, 0, 5), fixed(-1, 2, 5)};
       lay(s, [](double at) { return Vec3(0.4 * at, 0, 5.0 - 0.9 * std::min(at, 5.0 - at)); });
     }},
    {"the same, 10 N in the middle",
     [](scene::Scene& s) {
       s.world.fixed = {fixed(0, 0, 5), fixed(-1, 2, 5)};
       s.world.loads = {{25, {0, 0, -10}}};
       lay(s, [](double at) { return Vec3(0.4 * at, 0, 5.0 - 0.9 * std::min(at, 5.0 - at)); });
     }},
    {"between supports 4 m apart, 10 N aside",
     [](scene::Scene& s) {
       s.world.fixed = {fixed(0, 0, 5), fixed(-1, 4, 5)};
       s.world.loads = {{15, {0, 10, 0}}};
       lay(s, [](double at) { return Vec3(0.8 * at, 0, 5.0 - 0.6 * std::min(at, 5.0 - at)); });
     }},
    {"over three supports",
     [](scene::Scene& s) {
       s.world.fixed = {fixed(0, 0, 5), fixed(24, 1.6, 5), fixed(-1, 3.2, 5)};
       lay(s, [](double at) {
         const double half = at < 2.449 ? at : at - 2.449, span = at < 2.449 ? 2.449 : 2.551;
         return Vec3(at * 0.64, 0, 5.0 - 0.7 * std::min(half, span - half));
       });
     }},
};

scene::GripperScript script_of(const std::string& name) {
  scene::GripperScript script;
  for (const auto& row : reference_rows(name)) {
    script.keys[row.at("hand") == "L" ? 0 : 1].push_back(
        {number(row, "time"), {number(row, "x"), number(row, "y"), number(row, "z")}, number(row, "grip") != 0.0});
  }
  return script;
}

std::string tied_by(const std::string& script_name) {
  const auto script = script_of(script_name);
  auto sim = build(paper_scene(scene::Model::kRod));
  const int ticks = static_cast<int>(1000.0 * (scene::end_time_s(script) + 10.0));
  Tools tools{};
  for (int k = 1; k <= ticks && sim.diagnostics().finite; ++k) {
    for (std::size_t h = 0; h < 2; ++h) {
      const auto pose = scene::sample(script.keys[h], 1e-3 * k);
      tools[h] = {Vec3(pose.p_W_m.data()), Vec3(pose.v_W_m_per_s.data()), pose.grip};
    }
    proceed(sim, tools);
  }
  std::vector<std::array<double, 3>> points;
  for (const auto& p : sim.nodes_W()) points.push_back({p.x(), p.y(), p.z()});
  return knot::recognise(points, false).type;
}

}  // namespace

scene::Scene paper_scene(scene::Model model) {
  scene::Scene s;
  s.suture.model = model;
  s.suture.paper.air_drag_per_s = 1.0;
  s.world.fixed.push_back({0, {0, 0, 5.5}, std::nullopt});
  s.world.grippers_collide = false;
  const auto& p = s.suture.paper;
  const double l = segment_m(s);
  auto& r = s.suture.rod;
  r.density_kg_per_m = p.node_mass_kg * s.suture.nodes / s.suture.length_m;
  r.EA_N = p.stretch_N;
  r.EI_N_m2 = p.bend * l / std::numbers::pi;
  r.GJ_N_m2 = 0.0;
  r.stretch_damping_s = p.stretch_damping * l / p.stretch_N;
  r.damping_s = p.bend_damping * std::numbers::pi / p.bend;
  r.air_drag_per_s = p.air_drag_per_s;
  r.spacing = scene::Spacing::kUniform;
  return s;
}

Findings paper_static_shapes(const Subject&) {  // compares at the paper's 50 nodes
  Findings all;
  for (const auto& pose : kPoses) {
    Shape shapes[2];
    for (const auto model : {scene::Model::kPaper4, scene::Model::kRod}) {
      auto s = paper_scene(model);
      pose.prepare(s);
      shapes[model == scene::Model::kRod] = at_rest(s);
    }
    all.push_back(absolute(std::string(pose.name) + ": largest distance of a node, of L", 0.0,
                           apart(shapes[0], shapes[1]) / 5.0, 0.02, "of L"));
  }
  return all;
}

Findings paper_knots(const Subject&) {  // the operators' scripts; checked ten seconds after the release
  Findings all;
  const std::pair<const char*, const char*> scripts[] = {{"overhand.csv", "3_1"}, {"figure-eight.csv", "4_1"}};
  for (const auto& [name, wanted] : scripts) {
    const auto found = tied_by(name);
    all.push_back(within(std::string(name) + ": wanted " + wanted + ", tied " + found + " (1: the same)", 1.0, 1.0,
                         found == wanted ? 1.0 : 0.0));
  }
  return all;
}

}  // namespace ligature::validate
