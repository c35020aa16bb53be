// The surroundings of a thread. Each of desk, peg, open gripper, clamp with load, and jaws is tested with a piece of
// the shipped suture; the frame is tested with the paper's suture.

#include <cmath>
#include <numbers>

#include "host/lab/loading.hpp"
#include "host/lab/regress/scene.hpp"
#include "host/lab/validate/capstan.hpp"
#include "host/lab/validate/specimen.hpp"

namespace ligature::regress {
namespace {

using physics::Vec3;
using namespace validate;  // NOLINT: the threads and the helpers of the validation cases

constexpr double kG = 9.81;
constexpr Subject kSubject{scene::Model::kRod, 31, scene::Accuracy::kBalanced};

/// 30 mm of the suture, lying along x on a desk.
scene::Scene lying(double friction) {
  auto scene = real_thread(kSubject, 0.1, friction);
  set_drag(scene, 0.0);
  scene.world.desk_height_m = 0.0;
  lay(scene, [&](double s) { return Vec3(s, 0, scene.suture.radius_m); });
  return scene;
}

/// The suture hanging from its first node.
scene::Scene hanging() {
  auto scene = real_thread(kSubject, 0.2, 0.3);
  scene.world.gravity_m_per_s2 = {0, 0, -kG};
  scene.world.fixed.push_back({0, {0, 0, 0}, std::nullopt});
  lay(scene, [](double s) { return Vec3(0, 0, -s); });
  return scene;
}

Vec3 middle(const physics::Simulation& sim) { return sim.nodes_W()[sim.nodes_W().size() / 2]; }

}  // namespace

Figures desk(const Bench&) {
  auto scene = lying(0.3);
  scene.world.gravity_m_per_s2 = {0, 0, -kG};
  auto sim = build(scene);
  const std::vector<Vec3> places(sim.nodes_W().begin(), sim.nodes_W().end());
  sim.set_state(places, std::vector<Vec3>(places.size(), Vec3(0, 0.3, 0)));
  for (int k = 0; k < 200; ++k) proceed(sim, no_hands());
  return {{"distance until it stops (mm)", 1000.0 * middle(sim).y(), 0.15},
          {"height above the desk (mm)", 1000.0 * middle(sim).z(), 0.001}};
}

Figures static_friction(const Bench&) {  // slope: tan = 0.35, between the two coefficients
  auto scene = lying(0.3);
  scene.contact.static_friction = 0.4;
  const double slope = std::atan(0.35);
  scene.world.gravity_m_per_s2 = {0, kG * std::sin(slope), -kG * std::cos(slope)};
  auto held = build(scene);
  for (int k = 0; k < 200; ++k) proceed(held, no_hands());
  scene.contact.static_friction.reset();
  auto slides = build(scene);
  for (int k = 0; k < 200; ++k) proceed(slides, no_hands());
  return {{"way with static friction (mm)", 1000.0 * middle(held).y(), 0.01},
          {"way without it (mm)", 1000.0 * middle(slides).y(), 0.2}};
}

Figures peg(const Bench&) {
  return {{"ratio of the tensions, friction 0.3",
           tension_ratio({scene::Model::kRod, 49, kSubject.accuracy}, 0.3, std::numbers::pi, 24), 0.02}};
}

Figures drum(const Bench&) {
  return {{"ratio of the tensions, friction 0.3",
           tension_ratio({scene::Model::kRod, 49, kSubject.accuracy}, 0.3, std::numbers::pi, 24, 0.005), 0.02}};
}

Figures gripper(const Bench&) {
  auto scene = hanging();
  scene.world.grippers_collide = true;
  auto sim = build(scene);
  Tools tools = no_hands();
  tools[0].p_WT = Vec3(-0.005, 0.0003, -0.03);  // the gripper is a bar along y, and its tip lies beyond the thread
  tools[0].v_WT = Vec3(0.05, 0, 0);
  for (int k = 0; k < 300; ++k) {
    tools[0].p_WT += scene.time.tick_s * tools[0].v_WT;
    proceed(sim, tools);
  }
  return {{"thread at the height of the gripper, x (mm)", 1000.0 * middle(sim).x(), 0.1},
          {"end of the thread, x (mm)", 1000.0 * sim.nodes_W().back().x(), 0.3}};
}

Figures clamp_and_load(const Bench&) {
  auto scene = real_thread(kSubject, 0.2, 0.3);
  clamp_start(scene);
  scene.world.gravity_m_per_s2 = {0, 0, -kG};
  scene.world.loads.push_back({-1, {0, 2e-4, 0}});
  auto sim = build(scene);
  settle(sim, no_hands(), 1e-4, 3000);
  const Vec3 tip = sim.nodes_W().back();
  return {{"tip, x (mm)", 1000.0 * tip.x(), 0.05},
          {"tip, y (mm)", 1000.0 * tip.y(), 0.05},
          {"tip, z (mm)", 1000.0 * tip.z(), 0.05}};
}

Figures jaws(const Bench&) {
  auto scene = hanging();
  scene.hands.pinch_width_m = 0.004;
  scene.hands.pinch_force_N = 0.5;
  auto sim = build(scene);
  Tools tools = no_hands();
  tools[1] = {middle(sim), Vec3(0, 0, -0.05), true};
  double most_N = 0.0;
  for (int k = 0; k < 300; ++k) {
    tools[1].p_WT += scene.time.tick_s * tools[1].v_WT;
    proceed(sim, tools);
    most_N = std::max(most_N, sim.hand(physics::Hand::kRight).f_W.norm());
  }
  return {{"largest pull, 2 mu F = 0.3 (N)", most_N, 0.005},
          {"pull while it slips (N)", sim.hand(physics::Hand::kRight).f_W.norm(), 0.005}};
}

Figures frame(const Bench& bench) {
  auto scene = lab::load_scene_or_refuse((bench.scenes / "paper.toml").string(), {});
  auto sim = build(scene);
  // The thread runs 1 m along y from the frame, and then back beside the hook. This last part moves towards the hook at
  // 1 m/s.
  const Vec3 fixed = sim.nodes_W()[0];
  const auto at = [](double s) {
    return s < 1.0 ? Vec3(0, s, 0) : s < 1.2 ? Vec3(0.8 * (1.0 - s), 1, 0.1) : Vec3(-0.15, 2.2 - s, 0.1);
  };
  std::vector<Vec3> places, speeds;
  const std::size_t n = sim.nodes_W().size();
  for (std::size_t i = 0; i < n; ++i) {
    const double s = scene.suture.length_m * static_cast<double>(i) / static_cast<double>(n - 1);
    places.push_back(fixed + at(s));
    speeds.emplace_back(s < 1.2 ? 0.0 : 1.0, 0, 0);
  }
  sim.set_state(places, speeds);
  for (int k = 0; k < 90; ++k) proceed(sim, no_hands());
  const Vec3 caught = sim.nodes_W()[22] - fixed;
  return {{"node at the hook, x (mm)", 1000.0 * caught.x(), 1.0},
          {"node at the hook, z (mm)", 1000.0 * caught.z(), 2.0}};
}

}  // namespace ligature::regress
