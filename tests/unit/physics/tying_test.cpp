#include <gtest/gtest.h>

#include "tests/unit/physics/script_run.hpp"

namespace ligature::physics {
namespace {

using test::knot_of;
using test::make;
using test::overhand;
using test::paper_scene;
using test::play;
using test::Variation;

Simulation tied(int nodes, double end_s, const Variation& how = {}, const std::string& extra = "contact.friction=0.3") {
  Simulation sim = make(paper_scene({"suture.nodes=" + std::to_string(nodes), extra}));
  play(sim, overhand(), 0.0, end_s / how.speed, how);
  return sim;
}

// The script releases everything at 21 s; the knot must then stay tied without hands.
TEST(Tying, TheOverhandScriptTiesATrefoilThatHoldsTenSecondsAfterRelease) {
  for (const int nodes : {20, 35, 50}) {
    const Simulation sim = tied(nodes, 31.0);
    ASSERT_TRUE(sim.diagnostics().finite);
    EXPECT_EQ(knot_of(sim).type, "3_1") << nodes << " nodes";
    EXPECT_GT(sim.diagnostics().min_gap_m, -0.1 * 0.05) << nodes << " nodes";
  }
}

TEST(Tying, AtLowFrictionTheReleasedTrefoilSlipsOff) {
  const Simulation sim = tied(50, 45.0, {}, "contact.friction=0.1");
  EXPECT_EQ(knot_of(sim).type, "0_1");
}

TEST(Tying, TheScriptMayBeTurnedPlayedFasterOrSlower) {
  for (const int nodes : {35, 50})
    for (const Variation& how : {Variation{.turn_rad = 0.7}, Variation{.turn_rad = 1.5707963}, Variation{.speed = 1.25},
                                 Variation{.speed = 0.75}}) {
      const auto knot = knot_of(tied(nodes, 30.0, how));
      EXPECT_EQ(knot.type, "3_1") << nodes << " nodes, speed " << how.speed << ", turn " << how.turn_rad;
      EXPECT_EQ(knot.handedness, "right") << nodes << " nodes";
    }
}

TEST(Tying, TheMirroredScriptTiesTheMirrorKnot) {
  for (const int nodes : {35, 50}) {
    const auto knot = knot_of(tied(nodes, 30.0, {.mirrored = true}));
    EXPECT_EQ(knot.type, "3_1") << nodes << " nodes";
    EXPECT_EQ(knot.handedness, "left") << nodes << " nodes";
  }
}

}  // namespace
}  // namespace ligature::physics
