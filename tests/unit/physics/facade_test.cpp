// Guarantees of physics::Simulation, the interface (facade) of all thread models.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "tests/unit/physics/script_run.hpp"

namespace ligature::physics {
namespace {

using test::make;
using test::paper_scene;

/// The paper's scene with another thread model, set directly; in a scene file, the keys of the old model would have to
/// be removed.
scene::Scene scene_of(scene::Model model, const std::vector<std::string>& overrides = {}) {
  auto scene = paper_scene(overrides);
  scene.suture.model = model;
  return scene;
}

class Facade : public testing::TestWithParam<scene::Model> {
 protected:
  Simulation sim_ = make(scene_of(GetParam()));
  /// Tools of which the left one grips at a node in the middle of the thread.
  std::array<ToolInput, 2> holding() const { return {ToolInput{sim_.nodes_W()[25], Vec3::Zero(), true}, ToolInput{}}; }
};

TEST_P(Facade, AfterSetStateHandsAreOpenAndAButtonThatIsDownTakesTheThreadAgain) {
  const auto tools = holding();
  sim_.tick(tools);
  ASSERT_GE(sim_.hand(Hand::kLeft).node, 0);
  const std::vector<Vec3> shape(sim_.nodes_W().begin(), sim_.nodes_W().end());
  sim_.set_state(shape, {});
  EXPECT_EQ(sim_.hand(Hand::kLeft).node, -1);
  sim_.tick(tools);
  EXPECT_GE(sim_.hand(Hand::kLeft).node, 0);
}

TEST_P(Facade, AfterResetItIsAsItWasMade) {
  const std::vector<Vec3> first(sim_.nodes_W().begin(), sim_.nodes_W().end());
  const auto tools = holding();
  for (int k = 0; k < 20; ++k) sim_.tick(tools);
  sim_.reset();
  EXPECT_EQ(sim_.hand(Hand::kLeft).node, -1);
  EXPECT_EQ(std::vector<Vec3>(sim_.nodes_W().begin(), sim_.nodes_W().end()), first);
}

TEST_P(Facade, GoesOnFromAnotherOneOfItsModelAndNumberOfNodesOnly) {
  Simulation same = make(scene_of(GetParam(), {"contact.friction=0.4"})),
             fewer = make(scene_of(GetParam(), {"suture.nodes=40"}));
  Simulation other = make(scene_of(GetParam() == scene::Model::kRod ? scene::Model::kPaper4 : scene::Model::kRod));
  const auto tools = holding();
  for (int k = 0; k < 20; ++k) sim_.tick(tools);
  EXPECT_FALSE(fewer.continue_from(sim_));
  EXPECT_FALSE(other.continue_from(sim_));
  ASSERT_TRUE(same.continue_from(sim_));
  EXPECT_EQ(std::vector<Vec3>(same.nodes_W().begin(), same.nodes_W().end()),
            std::vector<Vec3>(sim_.nodes_W().begin(), sim_.nodes_W().end()));
  EXPECT_EQ(same.hand(Hand::kLeft).node, sim_.hand(Hand::kLeft).node);
}

/// The reach is measured to the thread, not to its nodes, which are 10 cm apart.
TEST_P(Facade, JawsHoldWhatIsWithinTheirReach) {
  const Simulation start = make(scene_of(GetParam(), {"hands.reach_m=0.06"}));
  const Vec3 between = 0.5 * (start.nodes_W()[25] + start.nodes_W()[26]);
  std::array<ToolInput, 2> tools{};
  const auto close_at = [&](Simulation& sim, double off_m) {
    tools[0] = {between + Vec3(off_m, 0, 0), Vec3::Zero(), true};
    sim.tick(tools);
    return sim.hand(Hand::kLeft).node;
  };
  Simulation near = start, far = start;
  EXPECT_GE(close_at(near, 0.059), 25);
  EXPECT_EQ(close_at(far, 0.061), -1);
  EXPECT_EQ(far.hand(Hand::kLeft).f_W, Vec3(0, 0, 0));
  EXPECT_EQ(close_at(far, 0.0), -1) << "closed jaws take nothing that comes by";
  tools[0].grip = false;
  far.tick(tools);
  EXPECT_GE(close_at(far, 0.0), 25);
}

/// Jaws close half a metre beside the thread while the tool moves: the force has no step, the thread is not thrown, and
/// in the end the node itself is held.
TEST_P(Facade, JawsThatCloseFarOffBringTheThreadGently) {
  constexpr double kOff_m = 0.5, kSpeed_m_per_s = 0.2;
  constexpr double kSpring_N_per_m = 1200.0;
  std::array<ToolInput, 2> tools{ToolInput{sim_.nodes_W()[25] + Vec3(kOff_m, 0, 0), Vec3::Zero(), false}, ToolInput{}};
  Vec3 before = Vec3::Zero();
  double step_N = 0.0, most_N = 0.0;
  for (int k = 0; k < 1500; ++k) {
    tools[0].grip = k > 0;
    tools[0].v_WT = k < 300 ? Vec3(0, kSpeed_m_per_s, 0) : Vec3::Zero();
    tools[0].p_WT += 1e-3 * tools[0].v_WT;
    sim_.tick(tools);
    const HandContact& hand = sim_.hand(Hand::kLeft);
    step_N = std::max(step_N, (hand.f_W - before).norm());
    most_N = std::max(most_N, hand.f_W.norm());
    before = hand.f_W;
  }
  std::printf("closed 0.5 m off: steps of %.2f N at most, %.1f N at most\n", step_N, most_N);
  const HandContact& hand = sim_.hand(Hand::kLeft);
  ASSERT_GE(hand.node, 0);
  EXPECT_LT(step_N, 0.03 * kSpring_N_per_m * kOff_m);  // without a gradual approach the whole force would act at once
  EXPECT_LT(most_N, 0.3 * kSpring_N_per_m * kOff_m);
  EXPECT_EQ(hand.p_WG, sim_.nodes_W()[static_cast<std::size_t>(hand.node)]);
}

/// In the paper's models a node stands for half a segment on either side, so thread between the jaws is held at once.
TEST(PaperGrasp, HoldsAtOnceWhatIsBetweenTheJaws) {
  Simulation sim = make(paper_scene({}));
  const Vec3 a = sim.nodes_W()[25], b = sim.nodes_W()[26];
  std::array<ToolInput, 2> tools{ToolInput{Vec3(0.7 * a + 0.3 * b), Vec3::Zero(), true}, ToolInput{}};
  sim.tick(tools);
  const HandContact& hand = sim.hand(Hand::kLeft);
  EXPECT_EQ(hand.node, 25);
  EXPECT_EQ(hand.p_WG, sim.nodes_W()[25]);
  EXPECT_GT(hand.f_W.norm(), 0.5 * 1200.0 * 0.3 * (b - a).norm());
}

/// NaN or infinity in a tool (jaws closed, open, or with orientation), in a shape or in a velocity must not change the
/// thread.
TEST_P(Facade, WhatIsNoNumberStopsItAsItIs) {
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  const auto shape = [](const Simulation& sim) {
    return std::vector<Vec3>(sim.nodes_W().begin(), sim.nodes_W().end());
  };
  const auto fine = holding();
  for (const double bad : {nan, inf, -inf, 1e300, 1e10}) {
    for (int kind = 0; kind < 6; ++kind) {
      Simulation sim = sim_;
      for (int k = 0; k < 10; ++k) sim.tick(fine);
      const auto before = shape(sim);
      auto tools = fine;
      std::vector<Vec3> p = before, v(p.size(), Vec3::Zero());
      switch (kind) {
        case 0:
          tools[0].p_WT.x() = bad;
          break;
        case 1:
          tools[0].v_WT.y() = bad;
          break;
        case 2:
          tools[1].p_WT.z() = bad;
          break;
        case 3:
          tools[1].grip = true, tools[1].R_WT = Eigen::Quaterniond(nan, 0, 0, 1);
          break;
        case 4:
          p[7].x() = bad;
          break;
        default:
          v[7].z() = bad;
          break;
      }
      kind < 4 ? sim.tick(tools) : sim.set_state(p, v);
      EXPECT_FALSE(sim.diagnostics().finite) << kind << ": " << bad;
      EXPECT_EQ(sim.diagnostics().bad_node, kind < 4 ? -1 : 7);
      EXPECT_EQ(shape(sim), before) << kind << ": " << bad;
      EXPECT_EQ(sim.hand(Hand::kLeft).node, -1);
      EXPECT_EQ(sim.hand(Hand::kLeft).f_W, Vec3(0, 0, 0));
      sim.tick(fine);
      EXPECT_EQ(shape(sim), before) << "it stays";
      sim.reset();
      sim.tick(fine);
      EXPECT_TRUE(sim.diagnostics().finite) << "until it is reset";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Models, Facade, testing::Values(scene::Model::kPaper4, scene::Model::kRod),
                         [](const auto& model) { return model.param == scene::Model::kRod ? "Rod" : "Paper"; });

/// A thread compressed into less than its own diameter: every pair of segments touches, more than the list can hold.
TEST(Bounds, AListOfContactsThatIsFullSaysSoAndGrowsNoFurther) {
  for (const char* solver : {"implicit", "paper"}) {
    auto crushed = [&](int nodes) {
      Simulation sim = make(paper_scene({"suture.nodes=" + std::to_string(nodes), "suture.model=\"paper-4\"",
                                         std::string("contact.solver=\"") + solver + "\""}));
      std::vector<Vec3> p_W;
      for (int i = 0; i < nodes; ++i)
        p_W.push_back(Vec3(0.5, -0.4, 3.0) + 1e-3 * Vec3(i % 7 - 3, i % 5 - 2, 0.1 * (i % 11)));
      sim.set_state(p_W, {});
      sim.tick({});
      return sim.diagnostics();
    };
    const auto d = crushed(200);
    EXPECT_TRUE(d.contact_cap_hit) << solver;
    EXPECT_LE(d.contacts, 64 * 200 + 256) << solver;
    EXPECT_TRUE(d.finite) << solver;
    EXPECT_FALSE(crushed(20).contact_cap_hit) << solver;
  }
}

TEST(Frame, MoreHooksThanThereIsRoomForAreRefusedNotForgotten) {
  std::string fixed;
  for (int k = 0; k < 7; ++k)
    fixed += std::string(k ? ", " : "") + "{node=" + std::to_string(7 * k) + ", position_m=[" + std::to_string(k) +
             ".0,0.0,1.0]}";
  const auto scene = paper_scene({"world.fixed=[" + fixed + "]"});
  const auto refused = Simulation::make(scene);
  ASSERT_TRUE(std::holds_alternative<std::string>(refused));
  EXPECT_NE(std::get<std::string>(refused).find("world.fixed: found 7, allowed 6"), std::string::npos);
  auto without = scene;
  without.world.frame_collides = false;
  EXPECT_TRUE(std::holds_alternative<Simulation>(Simulation::make(without)));
}

}  // namespace
}  // namespace ligature::physics
