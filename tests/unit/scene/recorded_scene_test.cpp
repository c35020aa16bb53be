// A scene read back from a recording equals the scene that was run.
#include <gtest/gtest.h>

#include "ligature_source_dir.hpp"
#include "protocol/scene/recorded_scene.hpp"
#include "protocol/scene/scene_file.hpp"
#include "protocol/scene/text_file.hpp"

namespace ligature::scene {
namespace {

const std::string kKnot = LIGATURE_SOURCE_DIR "/scenes/suture-3-0-knot.toml";

Scene parsed(const std::string& text, const std::string& path, const std::vector<std::string>& overrides) {
  return std::get<Scene>(parse_scene(text, path, overrides));
}

TEST(RecordedScene, HasTheTextAndEveryOverrideInItsOrder) {
  const std::string text = "[suture]\nnodes = 20\n# --set suture.nodes=7";
  const std::vector<std::string> overrides{"suture.nodes=30", " contact.friction = 0.25"};
  const Scene scene = parsed(text, "a.toml", overrides);
  const std::string told =
      recorded_text(text, overrides, scene) + "\n# --force: too slow\n\n# --set suture.length_m=2.5";
  const auto split = split_recorded(told);
  EXPECT_EQ(split.text, text);
  EXPECT_EQ(split.overrides,
            (std::vector<std::string>{"suture.nodes=30", " contact.friction = 0.25", "suture.length_m=2.5"}));
  EXPECT_FALSE(split.shape.has_value());
  const auto again = std::get<Scene>(parse_recorded(told, "a.toml"));
  EXPECT_EQ(again.suture.nodes, 30);
  EXPECT_EQ(again.contact.friction, 0.25);
  EXPECT_EQ(again.suture.length_m, 2.5);
  EXPECT_EQ(parsed(told, "a.toml", {}).suture.nodes, 20) << "it is a scene file still, run and recorded again:";
  EXPECT_EQ(split_recorded(recorded_text(told, {}, scene)).text, told);
}

TEST(RecordedScene, TellsHowEarlyTheSamplesCanCome) {
  std::string told = recorded_text("[suture]\nnodes = 20", {}, {});
  EXPECT_EQ(split_recorded(told).samples_earliest_ns, 0) << "older recordings do not have it";
  add_earliest_samples(told, 380'000);
  add_override(told, "suture.nodes=30");
  EXPECT_EQ(split_recorded(told).samples_earliest_ns, 380'000);
  EXPECT_EQ(split_recorded(told).overrides, std::vector<std::string>{"suture.nodes=30"});
}

TEST(RecordedScene, OtherOverridesComeInThePlaceOfTheRecordedOnes) {
  const std::string text = "[suture]\nnodes = 20";
  const std::string told = recorded_text(text, std::vector<std::string>{"suture.nodes=30", "suture.length_m=2.5"}, {});
  const auto other = std::get<Scene>(parse_recorded(told, "a.toml", std::vector<std::string>{"suture.nodes=40"}));
  EXPECT_EQ(other.suture.nodes, 40);
  EXPECT_EQ(other.suture.length_m, 2.5);
}

TEST(RecordedScene, AnotherShapeThanTheRecordedOneIsRefused) {
  const std::string text = std::get<std::string>(read_text(kKnot, kMostScene_bytes));
  const Scene scene = parsed(text, kKnot, {});
  const std::string told = recorded_text(text, {}, scene);
  ASSERT_TRUE(split_recorded(told).shape.has_value());
  EXPECT_EQ(std::get<Scene>(parse_recorded(told, kKnot)).suture.initial_polyline_m, scene.suture.initial_polyline_m);
  Scene moved = scene;
  moved.suture.initial_polyline_m.back()[2] += 1e-12;
  const auto refused = parse_recorded(recorded_text(text, {}, moved), kKnot);
  ASSERT_TRUE(std::holds_alternative<Error>(refused));
  EXPECT_NE(std::get<Error>(refused).text.find("allowed the one of the recording"), std::string::npos);
  EXPECT_TRUE(std::holds_alternative<Error>(parse_recorded(told, "/nowhere/a.toml"))) << "its shape is not there";
}

}  // namespace
}  // namespace ligature::scene
