// Fuzz target: scene files. Every accepted scene is built and stepped; its state must stay finite or be reported as not
// finite.
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "firmware/physics/simulation.hpp"
#include "protocol/scene/scene_file.hpp"
#include "tests/fuzz/target.hpp"

namespace {

using ligature::physics::Simulation;
using ligature::physics::ToolInput;
using ligature::physics::Vec3;

/// Largest nodes x substeps that is stepped here. The firmware rejects slower scenes: it tries each in a child process
/// (the rehearsal) that has a time limit.
constexpr int kMostWork = 20'000;

void require(bool good, const char* what) {
  if (good) return;
  std::fprintf(stderr, "fuzz_scene: %s\n", what);
  std::abort();
}

void tick(Simulation thread) {
  const auto n = thread.nodes_W().size();
  const Vec3 at[2] = {thread.nodes_W()[n / 3], thread.nodes_W()[2 * n / 3]};
  for (int k = 0; k < 10; ++k) {
    thread.tick({ToolInput{at[0], Vec3::Zero(), true}, ToolInput{at[1], Vec3::Zero(), true}});
    if (!thread.diagnostics().finite) return;  // reported; the firmware rejects such a scene
    for (const auto& p : thread.nodes_W())
      require(p.allFinite(), "a node that is no number, and the thread says finite");
    for (const auto hand : {ligature::physics::Hand::kLeft, ligature::physics::Hand::kRight})
      require(thread.hand(hand).f_W.allFinite(), "a force that is no number");
  }
}

}  // namespace

std::vector<std::string> ligature::fuzz::seeds() {
  auto all = files_in("scenes", ".toml");
  // Every key that the reader knows, so that mutations find numbers to change.
  all.emplace_back(
      "[suture]\nmodel = \"paper-5\"\nnodes = 9\nlength_m = 1.0\nradius_m = 0.01\nnode_mass_kg = 1e-3\nstretch_N = "
      "8e2\nbend = 1e1\nbend_damping = 5e-2\nswivel_damping = 2e-1\nreference_nodes = 50\ndamping = "
      "\"explicit\"\nintegrator = \"forward\"\nair_drag_per_s = 1e0\n[contact]\nsolver = \"paper\"\nfriction = "
      "3e-1\nrepulsion_N_per_m = 1e2\nrepulsion_N_s_per_m = 5e0\n[world]\ngravity_m_per_s2 = [0.0, 0.0, -9.8]\nfixed "
      "= [{node = 0, position_m = [0.0, 0.0, 1.5], direction = [0.0, 0.0, -1.0]}]\nloads = [{node = -1, force_N = "
      "[0.0, "
      "1e-3, 0.0]}]\ndesk_height_m = 0.1\n[time]\ntick_s = 1e-3\nsubsteps = 4\n[hands]\npropagation = true\n");
  all.emplace_back(
      "[suture]\nmodel = \"rod\"\nnodes = 12\nlength_m = 0.2\nradius_m = 1e-3\ndensity_kg_per_m = 8e-5\nEA_N = "
      "7e1\nEI_N_m2 = 4e-7\nGJ_N_m2 = 3e-7\nrest_curvature_per_m = 1e1\nrest_twist_per_m = 1e0\nyield_strain = "
      "2e-2\ndamping_s = 2e-3\nstretch_damping_s = 5e-4\nspacing = \"uniform\"\n[contact]\nfriction = "
      "3e-1\nturns_thread = true\n[world]\npegs = [{from_m = [0.0, 0.0, 0.0], to_m = [1e-1, 0.0, 0.0], radius_m = "
      "1e-2}]\ndesk_height_m = -1e-1\n[hands]\nreach_m = 1e-2\npinch_width_m = 2e-3\npinch_force_N = 5e0\n");
  return all;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const ligature::fuzz::MemoryFile file(data, size);
  const auto read = ligature::scene::load_scene(file.path(), {});
  const auto* scene = std::get_if<ligature::scene::Scene>(&read);
  if (scene == nullptr) return 0;
  auto made = Simulation::make(*scene);
  if (auto* thread = std::get_if<Simulation>(&made); thread && scene->suture.nodes * scene->time.substeps <= kMostWork)
    tick(std::move(*thread));
  return 0;
}
