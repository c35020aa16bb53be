// A copy of a simulation, made while a knot is pulled tight, continues like the original.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "firmware/physics/rod/rod_simulation.hpp"
#include "protocol/scene/scene_file.hpp"

namespace ligature::test {
namespace {

using physics::Hand;
using physics::ToolInput;
using physics::rod::RodSimulation;

RodSimulation knotted() {
  auto read = scene::load_scene(LIGATURE_SOURCE_DIR "/scenes/suture-3-0-knot.toml", {});
  if (auto* error = std::get_if<scene::Error>(&read)) throw std::runtime_error(error->text);
  auto made = RodSimulation::make(std::get<scene::Scene>(read));
  if (auto* why = std::get_if<std::string>(&made)) throw std::runtime_error(*why);
  return std::get<RodSimulation>(std::move(made));
}

double pull_N(const RodSimulation& sim) {
  return 0.5 * (sim.hand(Hand::kLeft).f_W.x() - sim.hand(Hand::kRight).f_W.x());
}

/// Contacts decide where remeshing puts nodes, so a copy without the contacts would have another mesh from the next
/// tick on. The copy rebuilds the contact list and matrices, which changes only rounding: 3 mN here, on the way to 5 N.
TEST(Copy, RemeshesAsItsOriginal) {
  RodSimulation sim = knotted();
  std::array<ToolInput, 2> tools{};
  tools[0] = {sim.nodes_W().front(), {-0.2, 0, 0}, true, {}};
  tools[1] = {sim.nodes_W().back(), {0.2, 0, 0}, true, {}};
  int remeshes = 0;
  double apart_N = 0.0;
  for (int k = 0; k < 1000 && pull_N(sim) < 5.0; ++k) {
    for (auto& tool : tools) tool.p_WT += 1e-3 * tool.v_WT;
    RodSimulation copy = sim;
    ASSERT_TRUE(copy.rod().contact_set().only_pairs()) << "a contact of the thread is one in a copy, too";
    copy.tick(tools);
    sim.tick(tools);
    remeshes += sim.rod().report().remeshes;
    apart_N = std::max(apart_N, std::abs(pull_N(copy) - pull_N(sim)));
    ASSERT_EQ(copy.rod().state().mesh.s, sim.rod().state().mesh.s) << "tick " << k;
  }
  EXPECT_GE(remeshes, 30);
  EXPECT_LT(apart_N, 5e-3);
  RecordProperty("apart_mN", std::to_string(1e3 * apart_N));
  RecordProperty("remeshes", remeshes);
}

}  // namespace
}  // namespace ligature::test
