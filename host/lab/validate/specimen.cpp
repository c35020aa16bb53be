#include "host/lab/validate/specimen.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "firmware/physics/rod/from_scene.hpp"

namespace ligature::validate {
namespace {

void clear_world(scene::Scene& s) {
  s.world.gravity_m_per_s2 = {0, 0, 0};
  s.world.grippers_collide = s.world.frame_collides = false;
  lay(s, [](double at) { return Vec3(at, 0, 0); });
}

}  // namespace

scene::Scene unit_thread(const Subject& subject, double tick_s, double drag_per_s) {
  scene::Scene s;
  s.suture.model = subject.model;
  s.suture.nodes = subject.nodes;
  s.suture.length_m = 1.0;
  s.suture.radius_m = 1e-3;
  s.contact.solver = scene::ContactSolver::kNone;
  s.time.tick_s = tick_s;
  auto& r = s.suture.rod;
  r = {};
  r.density_kg_per_m = 1.0;
  r.GJ_N_m2 = r.damping_s = r.stretch_damping_s = 0.0;
  r.spacing = scene::Spacing::kUniform;
  r.accuracy = scene::Accuracy::kFast;
  auto& p = s.suture.paper;
  p.node_mass_kg = segment_m(s);
  p.stretch_damping = p.bend_damping = p.swivel_damping = 0.0;
  set_bending(s, 1.0);
  set_stretch(s, is_rod(s) ? 1e6 : subject.model == scene::Model::kPaper5 ? 1e9 : 1e5);
  set_drag(s, drag_per_s);
  clear_world(s);
  return s;
}

scene::Scene real_thread(const Subject& subject, double share, double friction) {
  scene::Scene s;
  s.suture.model = subject.model;
  s.suture.nodes = subject.nodes;
  s.contact.friction = friction;
  if (is_rod(s)) {
    s.suture.length_m = 0.3 * share;
    s.suture.radius_m = 1.5e-4;
    s.suture.rod.GJ_N_m2 = 0.0;
    s.suture.rod.spacing = scene::Spacing::kUniform;
    s.suture.rod.accuracy = subject.accuracy.value_or(scene::Accuracy::kBalanced);
    s.suture.rod.work_instructions = static_cast<int>(subject.work_instructions);
    s.hands.coupling_N_per_m = 1000.0;
    s.hands.coupling_N_s_per_m = 0.5;
  } else {  // Table I for 50 nodes, converted to values per length
    s.suture.length_m = 5.0 * share;
    const double finer = segment_m(s) / (5.0 / 49.0);
    auto& p = s.suture.paper;
    p.node_mass_kg *= finer;
    p.stretch_damping /= finer;
    p.bend /= finer;
    p.bend_damping /= finer;
    p.swivel_damping /= finer * finer;
    p.air_drag_per_s = 1.0;
  }
  clear_world(s);
  return s;
}

void set_bending(scene::Scene& s, double EI_N_m2) {
  s.suture.rod.EI_N_m2 = EI_N_m2;
  s.suture.paper.bend = std::numbers::pi * EI_N_m2 / segment_m(s);
}

void set_stretch(scene::Scene& s, double EA_N) { s.suture.rod.EA_N = s.suture.paper.stretch_N = EA_N; }

void set_drag(scene::Scene& s, double per_s) { s.suture.rod.air_drag_per_s = s.suture.paper.air_drag_per_s = per_s; }

void clamp_start(scene::Scene& s) { s.world.fixed.push_back({0, {0, 0, 0}, scene::Vec{1, 0, 0}}); }

double clamp_end_m(const scene::Scene& s) { return is_rod(s) ? 0.0 : 0.5 * segment_m(s); }

void weigh(scene::Scene& s, double w_N_per_m, int axis) {
  for (int k = 0; k < s.suture.nodes; ++k) {
    const bool end = k == 0 || k + 1 == s.suture.nodes;
    scene::Load load{k, {0, 0, 0}};
    load.force_N[static_cast<std::size_t>(axis)] = -w_N_per_m * segment_m(s) * (end ? 0.5 : 1.0);
    s.world.loads.push_back(load);
  }
}

void make_stable(scene::Scene& s) {
  if (is_rod(s)) return;
  const auto& p = s.suture.paper;
  const double m = p.node_mass_kg, l = segment_m(s), EI = p.bend * l / std::numbers::pi;
  double limit_s = 2.0 * std::sqrt(m / std::max(s.hands.coupling_N_per_m, 1e-12));
  limit_s = std::min(limit_s, 0.5 * std::sqrt(m * l * l * l / std::max(EI, 1e-12)));
  if (s.suture.model != scene::Model::kPaper5) limit_s = std::min(limit_s, std::sqrt(m * l / p.stretch_N));
  s.time.substeps = std::max(s.time.substeps, static_cast<int>(std::ceil(s.time.tick_s / (0.5 * limit_s))));
}

double step_s(const scene::Scene& scene) {
  if (is_rod(scene)) return scene.time.tick_s / physics::rod::numerics_of(scene).substeps;
  auto s = scene;
  make_stable(s);
  return s.time.tick_s / s.time.substeps;
}

physics::Simulation build(const scene::Scene& scene) {
  auto s = scene;
  make_stable(s);
  auto made = physics::Simulation::make(s);
  if (auto* why = std::get_if<std::string>(&made)) throw std::runtime_error(*why);
  return std::get<physics::Simulation>(std::move(made));
}

Tools no_hands() {
  Tools tools{};
  for (auto& t : tools) t.p_WT = Vec3(1e3, 1e3, 1e3);
  return tools;
}

double fastest(const physics::Simulation& sim) {
  double most = 0.0;
  for (const auto& v : sim.velocities_W()) most = std::max(most, v.norm());
  return most;
}

bool settle(physics::Simulation& sim, const Tools& tools, double still_m_per_s, int most) {
  for (int k = 0; k < most; ++k) {
    proceed(sim, tools);
    if (!sim.diagnostics().finite) return false;
    if (k > 10 && fastest(sim) < still_m_per_s) return true;
  }
  return false;
}

}  // namespace ligature::validate
