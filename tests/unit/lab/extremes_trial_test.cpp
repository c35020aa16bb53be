// `ligature-lab experiment extremes` runs trials with extreme parameters: how a trial ends, and which of these endings
// count as a stop without a known cause.

#include <gtest/gtest.h>

#include <limits>

#include "host/lab/experiments/extremes.hpp"

namespace ligature::lab {
namespace {

scene::GripperScript hand_at(double x) {
  scene::GripperScript script;
  script.keys[1] = {{0.0, {0, 0, 0.05}, true}, {0.01, {x, 0, 0.05}, true}};
  return script;
}

TEST(ExtremesTrial, AHandThatIsNoNumberIsNamedAsThat) {
  scene::Scene rod;
  rod.suture.model = scene::Model::kRod;
  rod.suture.nodes = 20;
  rod.suture.length_m = 0.3;
  rod.suture.radius_m = 1.5e-4;
  for (const auto& scene : {rod, scene::Scene{}}) {
    EXPECT_EQ(trial(scene, hand_at(0.01), 20).word, "finite");
    const Ending lost = trial(scene, hand_at(std::numeric_limits<double>::quiet_NaN()), 20);
    EXPECT_EQ(lost.word, "stopped");
    EXPECT_TRUE(lost.by_hand);
    EXPECT_GE(lost.tick, 0);
    ExtremesMap map;
    map.add("hand is not a number", lost);
    EXPECT_EQ(map.unnamed, 0);
  }
}

TEST(ExtremesTrial, AStopOfTheThreadNamesTickAndNode) {
  ExtremesMap map;
  map.add("named", {"stopped", 3, 0, "stiff"});
  EXPECT_EQ(map.unnamed, 0);
  map.add("no node", {"stopped", 3, -1, "stiff"});
  map.add("no tick", {"stopped", -1, 0, "stiff"});
  EXPECT_EQ(map.unnamed, 2);
}

}  // namespace
}  // namespace ligature::lab
