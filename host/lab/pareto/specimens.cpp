#include "host/lab/pareto/specimens.hpp"

#include <stdexcept>

namespace ligature::lab {

using physics::rod::RodSimulation;

Specimen::Specimen(const scene::Scene& scene, const Setting& setting) {
  if (setting.model != scene::Model::kRod) {
    auto made = physics::Simulation::make(scene);
    if (auto* why = std::get_if<std::string>(&made)) throw std::runtime_error(*why);
    thread_.emplace<physics::Simulation>(std::get<physics::Simulation>(std::move(made)));
    return;
  }
  auto made = RodSimulation::make(scene);
  if (auto* why = std::get_if<std::string>(&made)) throw std::runtime_error(*why);
  auto& rod = thread_.emplace<RodSimulation>(std::get<RodSimulation>(std::move(made)));
  if (!setting.preset.empty()) return;
  auto& numerics = rod.rod().numerics();
  numerics.substeps = numerics.max_substeps = setting.substeps;
  if (setting.passes > 0) numerics.max_passes = setting.passes;
  if (setting.passes >= 40) numerics.work = 40'000'000;
  if (setting.passes >= 40) numerics.settled_m_per_s = 1e-5;
}

void Specimen::tick(const validate::Tools& tools) noexcept {
  if (auto* rod = std::get_if<RodSimulation>(&thread_)) return rod->tick(tools);
  std::get_if<physics::Simulation>(&thread_)->tick(tools);
}

std::span<const physics::Vec3> Specimen::nodes_W() const noexcept {
  if (const auto* rod = std::get_if<RodSimulation>(&thread_)) return rod->nodes_W();
  return std::get_if<physics::Simulation>(&thread_)->nodes_W();
}

const physics::HandContact& Specimen::hand(physics::Hand h) const noexcept {
  if (const auto* rod = std::get_if<RodSimulation>(&thread_)) return rod->hand(h);
  return std::get_if<physics::Simulation>(&thread_)->hand(h);
}

const physics::Diagnostics& Specimen::diagnostics() const noexcept {
  if (const auto* rod = std::get_if<RodSimulation>(&thread_)) return rod->diagnostics();
  return std::get_if<physics::Simulation>(&thread_)->diagnostics();
}

scene::Scene thread_of(const Setting& setting) {
  auto scene = validate::real_thread({setting.model, setting.nodes}, 1.0, 0.3);
  scene.world.gravity_m_per_s2 = {0, 0, -9.81};
  if (setting.model == scene::Model::kRod) {
    scene.suture.rod.GJ_N_m2 = 2.86e-7;
    scene.suture.rod.spacing = scene::Spacing::kAdaptive;
    scene.suture.rod.accuracy = setting.preset == "fast"   ? scene::Accuracy::kFast
                                : setting.preset == "fine" ? scene::Accuracy::kFine
                                                           : scene::Accuracy::kBalanced;
  } else {
    scene.time.substeps = setting.substeps;
  }
  return scene;
}

int stable_substeps(scene::Model model, int nodes) {
  auto scene = validate::real_thread({model, nodes}, 1.0, 0.3);
  validate::make_stable(scene);
  return scene.time.substeps;
}

[[gnu::noinline]] void measured_tick(Specimen& specimen, const validate::Tools& tools) noexcept {
  specimen.tick(tools);
}

}  // namespace ligature::lab
