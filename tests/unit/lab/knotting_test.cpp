// Acceptance test of the knotting experiment: every shipped script ties its knot with 35 and 50 nodes, and the knot
// stays.

#include <gtest/gtest.h>

#include <numbers>

#include "host/lab/rehearsal.hpp"
#include "host/lab/script_moves.hpp"
#include "ligature_source_dir.hpp"

namespace ligature::lab {
namespace {

const std::string kScene = LIGATURE_SOURCE_DIR "/scenes/paper.toml";

/// The knot ten seconds after the release, e.g. "3_1 right".
std::string tied(const scene::GripperScript& script, const char* nodes) {
  Rehearsal r(load_scene_or_refuse(kScene, {nodes}), script);
  if (!r.run_until(release_time_s(script) + 10.0)) return "diverged";
  const auto k = knot_of(r.simulation());
  return k.type + " " + k.handedness;
}

scene::GripperScript shipped(const std::string& name) {
  return load_script_or_refuse(LIGATURE_SOURCE_DIR "/scenes/operators/" + name + ".csv");
}

TEST(Knotting, EveryShippedScriptTiesItsKnot) {
  for (const char* nodes : {"suture.nodes=35", "suture.nodes=50"}) {
    EXPECT_EQ(tied(shipped("overhand"), nodes), "3_1 right") << nodes;
    EXPECT_EQ(tied(shipped("overhand-mirrored"), nodes), "3_1 left") << nodes;
    EXPECT_EQ(tied(shipped("figure-eight"), nodes), "4_1 amphichiral") << nodes;
    EXPECT_EQ(tied(shipped("figure-eight-mirrored"), nodes), "4_1 amphichiral") << nodes;
  }
}

TEST(Knotting, TheOverhandScriptSurvivesTurningMirroringAndPace) {
  const auto script = shipped("overhand");
  for (const char* nodes : {"suture.nodes=35", "suture.nodes=50"}) {
    for (const double pace : {0.75, 1.25}) EXPECT_EQ(tied(paced(script, pace), nodes), "3_1 right") << pace;
    for (const double turn : {0.1, 0.25, 0.6}) {
      EXPECT_EQ(tied(turned(script, 2.0 * std::numbers::pi * turn), nodes), "3_1 right") << turn;
    }
    EXPECT_EQ(tied(mirrored(script), nodes), "3_1 left");
  }
}

}  // namespace
}  // namespace ligature::lab
