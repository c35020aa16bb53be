#include "host/view/scene_facts.hpp"

#include <gtest/gtest.h>

namespace ligature::host::view {
namespace {

constexpr const char* kPaper = R"([suture]
model = "paper-4"
length_m = 5.0
radius_m = 0.05
initial = "no-such-file.csv"
[world]
fixed = [{node = 0, position_m = [0.5, 0.0, 5.5]}]
grippers_collide = true
)";

TEST(SceneFacts, AreThoseOfTheSceneAsItRuns) {
  const auto file = scene_facts(kPaper, "paper.toml");
  EXPECT_EQ(file["length_m"], 5.0);
  EXPECT_EQ(file["fixed"], nlohmann::json::parse("[[0.5, 0.0, 5.5]]"));
  EXPECT_EQ(file["desk_height_m"], nullptr);
  EXPECT_EQ(file["gripper_m"], 0.2);
  EXPECT_EQ(file["equal_segments"], true);
  EXPECT_EQ(file["EA_N"], nullptr);

  const std::string as_run = std::string(kPaper) +
                             "\n# as run:\n# shape 0123abcd\n# --set suture.length_m=3\n# --set suture.initial=gone.csv"
                             "\n# --set world.desk_height_m=-0.1\n# --set world.grippers_collide=false";
  const auto run = scene_facts(as_run, "paper.toml");
  EXPECT_EQ(run["length_m"], 3.0);
  EXPECT_EQ(run["desk_height_m"], -0.1);
  EXPECT_EQ(run["gripper_m"], nullptr);
}

TEST(SceneFacts, OfARodSayThatItsSegmentsDifferAndHowStiffItIs) {
  const auto rod = scene_facts("[suture]\nmodel = \"rod\"\nEA_N = 71.0\n", "rod.toml");
  EXPECT_EQ(rod["equal_segments"], false);
  EXPECT_EQ(rod["EA_N"], 71.0);
  EXPECT_EQ(scene_facts("[suture]\nmodel = \"rod\"\nspacing = \"uniform\"\n", "r.toml")["equal_segments"], true);
}

TEST(SceneFacts, AreNullWhenTheTextIsNoScene) { EXPECT_EQ(scene_facts("what", "x.toml"), nullptr); }

}  // namespace
}  // namespace ligature::host::view
