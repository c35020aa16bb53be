// Properties of the thread itself: a stress-free shape, bends that stay, and the swing of every model.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/lab/regress/scene.hpp"
#include "host/lab/rehearsal.hpp"
#include "host/lab/script_tools.hpp"
#include "host/lab/validate/specimen.hpp"

namespace ligature::regress {
namespace {

using physics::Vec3;
using namespace validate;  // NOLINT: the threads and the helpers of the validation cases

constexpr double kG = 9.81;

/// Swing of a thread that is released as a horizontal arc with one end fixed. The figures are the place of the other
/// end after about a quarter of a swing, and later. The arc makes the thread swivel.
Figures swing_of(scene::Scene scene, double tolerance_m) {
  scene.world.gravity_m_per_s2 = {0, 0, -kG};
  scene.world.fixed.push_back({0, {0, 0, 0}, std::nullopt});
  const double r = 0.5 * scene.suture.length_m;
  lay(scene, [&](double s) { return Vec3(r * std::sin(s / r), r - r * std::cos(s / r), 0); });
  auto sim = build(scene);
  const double fall_s = std::sqrt(scene.suture.length_m / kG);
  Figures all;
  int ticks = 0;
  for (const double at : {1.0, 3.0}) {
    for (; ticks * scene.time.tick_s < at * fall_s; ++ticks) proceed(sim, no_hands());
    const Vec3 end = sim.nodes_W().back();
    const std::string when = at == 1.0 ? "early" : "late";
    all.push_back({"end of the thread, " + when + ", x (mm)", 1000.0 * end.x(), 1000.0 * tolerance_m});
    all.push_back({"end of the thread, " + when + ", y (mm)", 1000.0 * end.y(), 1000.0 * tolerance_m});
    all.push_back({"end of the thread, " + when + ", z (mm)", 1000.0 * end.z(), 1000.0 * tolerance_m});
  }
  return all;
}

}  // namespace

Figures curl(const Bench&) {
  auto scene = real_thread({scene::Model::kRod, 61, scene::Accuracy::kBalanced}, 0.2, 0.3);
  scene.suture.rod.GJ_N_m2 = 2.86e-7;
  scene.suture.rod.rest_curvature_per_m = 200.0;
  scene.suture.rod.rest_twist_per_m = 100.0;
  scene.contact.solver = scene::ContactSolver::kNone;
  scene.world.gravity_m_per_s2 = {0, 0, -kG};
  scene.world.fixed.push_back({0, {0, 0, 0}, scene::Vec{0, 0, -1}});
  set_drag(scene, 30.0);
  lay(scene, [](double s) { return Vec3(0, 0, -s); });
  auto sim = build(scene);
  for (int k = 0; k < 2000; ++k) proceed(sim, no_hands());
  double widest = 0.0;
  for (const auto& p : sim.nodes_W()) widest = std::max(widest, std::hypot(p.x(), p.y()));
  return {{"height of the end (mm)", 1000.0 * sim.nodes_W().back().z(), 0.1},
          {"largest distance from the vertical (mm)", 1000.0 * widest, 0.1}};
}

Figures set_bends(const Bench&) {
  auto scene = real_thread({scene::Model::kRod, 41, scene::Accuracy::kBalanced}, 0.05, 0.3);
  scene.suture.rod.GJ_N_m2 = 2.86e-7;
  scene.suture.rod.yield_strain = 0.05;
  scene.suture.rod.set_fraction = 0.35;
  scene.contact.solver = scene::ContactSolver::kNone;
  clamp_start(scene);
  auto sim = build(scene);
  Tools tools = no_hands();
  tools[1] = {sim.nodes_W().back(), Vec3::Zero(), true};
  const double from = tools[1].p_WT.x();
  for (int k = 0; k < 400; ++k) {  // the end goes round the clamp, above it and back to it
    const double turn = std::numbers::pi * std::min(1.0, k / 300.0), r = from * (1.0 - 0.9 * std::min(1.0, k / 300.0));
    tools[1].p_WT = Vec3(r * std::cos(turn), 0, r * std::sin(turn) + 0.1 * from);
    proceed(sim, tools);
  }
  tools[1].grip = false;
  tools[1].p_WT = Vec3(1e3, 1e3, 1e3);
  for (int k = 0; k < 600; ++k) proceed(sim, tools);
  const Vec3 end = sim.nodes_W().back(), along = end - sim.nodes_W()[sim.nodes_W().size() - 2];
  return {{"angle of the end that stays (deg)", std::atan2(along.z(), along.x()) * 180.0 / std::numbers::pi, 0.5},
          {"height of the end (mm)", 1000.0 * end.z(), 0.05}};
}

template <scene::Model M>
Figures swing(const Bench&) {
  return swing_of(real_thread({M, 30}, 1.0, 0.3), 0.02);
}
template Figures swing<scene::Model::kPaper1>(const Bench&);
template Figures swing<scene::Model::kPaper2>(const Bench&);
template Figures swing<scene::Model::kPaper3>(const Bench&);
template Figures swing<scene::Model::kPaper4>(const Bench&);
template Figures swing<scene::Model::kPaper5>(const Bench&);

template <scene::Accuracy A>
Figures rod_swing(const Bench&) {
  return swing_of(real_thread({scene::Model::kRod, 50, A}, 1.0, 0.3), 0.001);
}
template Figures rod_swing<scene::Accuracy::kFast>(const Bench&);
template Figures rod_swing<scene::Accuracy::kBalanced>(const Bench&);
template Figures rod_swing<scene::Accuracy::kFine>(const Bench&);

Figures paper_overhand(const Bench& bench) {
  lab::Rehearsal tying(lab::load_scene_or_refuse((bench.scenes / "paper.toml").string(), {"suture.nodes=35"}),
                       lab::load_script_or_refuse((bench.scenes / "operators/overhand.csv").string()));
  const auto& sim = tying.simulation();
  double most_N = 0.0;
  while (tying.time_s() < lab::default_duration_s(tying.script()) && tying.tick()) {
    for (const auto hand : {physics::Hand::kLeft, physics::Hand::kRight})
      most_N = std::max(most_N, sim.hand(hand).f_W.norm());
  }
  return {{"is a trefoil (1: yes)", lab::knot_of(sim).type == "3_1" ? 1.0 : 0.0, 0.0},
          {"largest pull (N)", most_N, 2.0},
          {"height of the end (mm)", 1000.0 * sim.nodes_W().back().z(), 20.0}};
}

}  // namespace ligature::regress
