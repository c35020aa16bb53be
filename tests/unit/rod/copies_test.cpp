// A copy of a simulation, made while a knot is pulled tight, continues like the original.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "firmware/physics/rod/rod_simulation.hpp"
#include "ligature_source_dir.hpp"
#include "protocol/scene/scene_file.hpp"

namespace ligature::test {
namespace {

using physics::Hand;
using physics::ToolInput;
using physics::rod::RodSimulation;

RodSimulation knotted(const std::vector<std::string>& overrides = {}) {
  auto read = scene::load_scene(LIGATURE_SOURCE_DIR "/scenes/suture-3-0-knot.toml", overrides);
  if (auto* error = std::get_if<scene::Error>(&read)) throw std::runtime_error(error->text);
  auto made = RodSimulation::make(std::get<scene::Scene>(read));
  if (auto* why = std::get_if<std::string>(&made)) throw std::runtime_error(*why);
  return std::get<RodSimulation>(std::move(made));
}

double pull_N(const RodSimulation& sim) {
  return 0.5 * (sim.hand(Hand::kLeft).f_W.x() - sim.hand(Hand::kRight).f_W.x());
}

/// Contacts decide where remeshing puts nodes, so a copy without the contacts would have another mesh from the next
/// tick on. The copy rebuilds the contact list and matrices, so its solution is another one within the tolerance.
struct Apart {
  int remeshes = 0;
  double force_N = 0.0;  ///< largest difference of the hands' forces after a tick, on the way to 5 N
};
Apart apart_in_a_pull(double m_per_s) {
  RodSimulation sim = knotted();
  std::array<ToolInput, 2> tools{};
  tools[0] = {sim.nodes_W().front(), {-m_per_s, 0, 0}, true, {}};
  tools[1] = {sim.nodes_W().back(), {m_per_s, 0, 0}, true, {}};
  Apart apart;
  for (int k = 0; k < 1000 && pull_N(sim) < 5.0; ++k) {
    for (auto& tool : tools) tool.p_WT += 1e-3 * tool.v_WT;
    RodSimulation copy = sim;
    EXPECT_TRUE(copy.rod().contact_set().only_pairs()) << "a contact of the thread is one in a copy, too";
    copy.tick(tools);
    sim.tick(tools);
    apart.remeshes += sim.rod().report().remeshes;
    apart.force_N = std::max(apart.force_N, std::abs(pull_N(copy) - pull_N(sim)));
    EXPECT_EQ(copy.rod().state().mesh.s, sim.rod().state().mesh.s) << m_per_s << " m/s, tick " << k;
  }
  return apart;
}

// Over 20 speeds the difference is 8 mN on average and 50 mN at most, and one outlier among the five does not matter.
TEST(Copy, RemeshesAsItsOriginal) {
  std::array<double, 5> apart_N{};
  for (std::size_t k = 0; k < apart_N.size(); ++k) {
    const Apart apart = apart_in_a_pull(0.16 + 0.02 * static_cast<double>(k));
    EXPECT_GE(apart.remeshes, 30);
    apart_N[k] = apart.force_N;
  }
  std::nth_element(apart_N.begin(), apart_N.begin() + 2, apart_N.end());
  EXPECT_LT(apart_N[2], 15e-3) << "median";
  RecordProperty("apart_mN", std::to_string(1e3 * apart_N[2]));
}

std::array<ToolInput, 2> at_the_ends(const RodSimulation& sim) {
  return {ToolInput{sim.nodes_W().front(), {-0.2, 0, 0}, true, {}},
          ToolInput{sim.nodes_W().back(), {0.2, 0, 0}, true, {}}};
}

void pull(RodSimulation& sim, std::array<ToolInput, 2>& tools, int ticks) {
  for (int k = 0; k < ticks; ++k) {
    for (auto& tool : tools) tool.p_WT += 1e-3 * tool.v_WT;
    sim.tick(tools);
  }
}

bool same(const RodSimulation& a, const RodSimulation& b) {
  return std::equal(a.nodes_W().begin(), a.nodes_W().end(), b.nodes_W().begin(), b.nodes_W().end());
}

/// A copy takes over the rod's state and computes everything else anew. With contact this changes rounding: the copy
/// builds its contact list and matrices in another tick than the original (see RemeshesAsItsOriginal). So this test
/// switches contact off. Then no bit may differ, also with plastic bending and twist.
TEST(Copy, WithoutContactContinuesToTheBit) {
  RodSimulation sim = knotted({"contact.solver=\"none\"", "suture.yield_strain=0.01", "suture.set_fraction=0.5"});
  auto tools = at_the_ends(sim);
  pull(sim, tools, 20);
  RodSimulation copy = knotted({"suture.nodes=120"});
  copy = sim;  // a rod of another size and with other parts
  double set_J = 0.0;
  for (int k = 0; k < 400; ++k) {
    tools[1].grip = k < 300;  // the released end whips
    auto again = tools;
    pull(sim, tools, 1);
    pull(copy, again, 1);
    ASSERT_TRUE(same(sim, copy)) << "tick " << k;
    set_J += sim.rod().report().set_J;
  }
  EXPECT_GT(set_J, 0.0);
}

/// A live change of a parameter goes on with the motion of the running rod: bends that stayed and the frames with them.
TEST(Copy, GoesOnWithBendsThatStay) {
  const std::vector<std::string> keys{"contact.solver=\"none\"", "suture.yield_strain=0.01", "suture.set_fraction=0.5"};
  RodSimulation sim = knotted(keys), next = knotted(keys);
  auto tools = at_the_ends(sim);
  double set_J = 0.0;
  for (int k = 0; k < 400; ++k) {
    tools[1].grip = k < 300;
    pull(sim, tools, 1);
    set_J += sim.rod().report().set_J;
  }
  ASSERT_GT(set_J, 0.0);
  ASSERT_TRUE(next.continue_from(sim));
  auto again = tools;
  for (int k = 0; k < 50; ++k) {
    pull(sim, tools, 1);
    pull(next, again, 1);
    ASSERT_TRUE(same(sim, next)) << "tick " << k;
  }
}

/// reset() assigns the rod of the start to one that has a list of pairs, matrices and impulses of its own.
TEST(Copy, ResetRepeatsThePullToTheBit) {
  RodSimulation sim = knotted();
  auto tools = at_the_ends(sim), again = tools;
  pull(sim, tools, 250);
  EXPECT_GT(sim.rod().report().contacts, 5);
  const RodSimulation first = sim;
  sim.reset();
  pull(sim, again, 250);
  EXPECT_TRUE(same(sim, first));
}

/// An assigned rod discards the list and the matrices that it had before, so it continues like a new copy.
TEST(Copy, AssignedOrNewIsTheSameToTheBit) {
  RodSimulation sim = knotted(), used = knotted();
  auto tools = at_the_ends(sim), others = tools;
  pull(sim, tools, 300);
  pull(used, others, 200);
  RodSimulation copy = sim;
  used = sim;
  for (int k = 0; k < 50; ++k) {
    auto again = tools;
    pull(copy, tools, 1);
    pull(used, again, 1);
    ASSERT_TRUE(same(used, copy)) << "tick " << k;
  }
  EXPECT_GT(copy.rod().report().contacts, 5);
}

/// The nodes of a moving mesh are at places where a uniform mesh has no nodes.
TEST(Copy, GoesOnOnlyFromARodWhoseMeshMovesToo) {
  RodSimulation sim = knotted(), uniform = knotted({"suture.spacing=\"uniform\""}), same_mesh = knotted();
  auto tools = at_the_ends(sim);
  pull(sim, tools, 100);
  EXPECT_FALSE(uniform.continue_from(sim));
  EXPECT_FALSE(sim.continue_from(uniform));
  ASSERT_TRUE(same_mesh.continue_from(sim));
  EXPECT_TRUE(same(same_mesh, sim));
}

}  // namespace
}  // namespace ligature::test
