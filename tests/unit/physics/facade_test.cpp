// What the facade promises of every model alike.
#include <gtest/gtest.h>

#include <vector>

#include "tests/unit/physics/script_run.hpp"

namespace ligature::physics {
namespace {

using test::make;
using test::paper_scene;

class Facade : public testing::TestWithParam<const char*> {
 protected:
  Simulation sim_ = make(paper_scene({std::string("suture.model=") + GetParam()}));
  /// The left hand's button is down at a node in the middle of the thread.
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
  const std::string model = std::string("suture.model=") + GetParam();
  Simulation same = make(paper_scene({model, "contact.friction=0.4"})),
             fewer = make(paper_scene({model, "suture.nodes=40"}));
  Simulation other =
      make(paper_scene({std::string("suture.model=") + (GetParam() == std::string("rod") ? "paper-4" : "rod")}));
  const auto tools = holding();
  for (int k = 0; k < 20; ++k) sim_.tick(tools);
  EXPECT_FALSE(fewer.continue_from(sim_));
  EXPECT_FALSE(other.continue_from(sim_));
  ASSERT_TRUE(same.continue_from(sim_));
  EXPECT_EQ(std::vector<Vec3>(same.nodes_W().begin(), same.nodes_W().end()),
            std::vector<Vec3>(sim_.nodes_W().begin(), sim_.nodes_W().end()));
  EXPECT_EQ(same.hand(Hand::kLeft).node, sim_.hand(Hand::kLeft).node);
}

INSTANTIATE_TEST_SUITE_P(Models, Facade, testing::Values("paper-4", "rod"),
                         [](const auto& model) { return std::string(model.param) == "rod" ? "Rod" : "Paper"; });

/// A thread crushed into less than its own thickness: every pair of segments touches, more than any list holds.
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
