// SceneDesk handles commands that change scene or parameters during a run: which are rejected, with which messages, and
// that the loop returns the objects that it gets from the desk.
#include "firmware/app/scene_desk.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "firmware/app/scene_preview.hpp"
#include "ligature_source_dir.hpp"
#include "protocol/scene/scene_file.hpp"
#include "tests/unit/firmware/scene_desk_fixture.hpp"

namespace ligature::app {
namespace {

TEST_F(SceneDeskTest, OffersTheScenesBesideTheFirstAndParametersWithRanges) {
  const auto offer = desk().offer();
  EXPECT_EQ(offer.scenes, (std::vector<std::string>{"huge.toml", "longer.toml", "small.toml", "wrong.toml"}));
  ASSERT_FALSE(offer.parameters.empty());
  EXPECT_EQ(offer.parameters[0].key, "contact.friction");
  for (const auto& p : offer.parameters) {
    EXPECT_LE(p.lowest, p.value) << p.key;
    EXPECT_GE(p.highest, p.value) << p.key;
  }
}

TEST_F(SceneDeskTest, PreviewsSayWhatASceneIsWithTheLaunchsOverrides) {
  options.overrides = {"suture.length_m=4.0"};
  const auto offer = desk().offer();
  ASSERT_EQ(offer.previews.size(), offer.scenes.size());
  EXPECT_EQ(offer.previews[1].facts, "paper-4, 20 nodes, 4 m long, 80 mm thick, fixed at 1 node, grippers collide");
  EXPECT_TRUE(std::isnan(offer.previews[1].desk_height_m));
  EXPECT_EQ(offer.previews[3].point_count, 0) << "wrong.toml";
  EXPECT_EQ(offer.previews[3].about, (folder / "wrong.toml:2: key 'suture.nodes': found 1, allowed integer 2 .. 5000"));
}

// The preview is made without the simulation, so its shape is compared with the start shape of the physics.
TEST(ScenePreview, ShowsTheStartShapeOfEachShippedScene) {
  for (const auto& entry : fs::directory_iterator(LIGATURE_SOURCE_DIR "/scenes")) {
    if (entry.path().extension() != ".toml") continue;
    const auto preview = preview_of(entry.path(), {});
    const auto scene = std::get<scene::Scene>(scene::load_scene(entry.path()));
    const auto thread = std::get<physics::Simulation>(physics::Simulation::make(scene));
    ASSERT_GE(preview.p_W_m.size(), 2U) << entry.path();
    EXPECT_FALSE(preview.about.empty() || preview.facts.empty()) << entry.path();
    EXPECT_EQ(!std::isnan(preview.desk_height_m), scene.world.desk_height_m.has_value());
    const auto off_m = [](const std::vector<float>& p, const physics::Vec3& q) {
      return std::hypot(p[0] - q.x(), p[1] - q.y(), p[2] - q.z());
    };
    const double most_m = 0.01 * scene.suture.length_m;
    EXPECT_LT(off_m(preview.p_W_m.front(), thread.nodes_W().front()), most_m) << entry.path();
    EXPECT_LT(off_m(preview.p_W_m.back(), thread.nodes_W().back()), most_m) << entry.path();
  }
}

TEST_F(SceneDeskTest, OffersOnlyWhatActsOnTheModelThatRuns) {
  const auto keys = [this](const std::string& model) {
    options.overrides = {"suture.model=" + model};
    std::set<std::string> offered;
    for (const auto& p : desk().offer().parameters) offered.insert(p.key);
    return offered;
  };
  const std::set<std::string> first{"contact.friction", "suture.stretch_N", "suture.stretch_damping",
                                    "hands.force_scale"};
  auto wanted = first;
  EXPECT_EQ(keys("paper-1"), wanted);
  wanted.insert("suture.bend");
  EXPECT_EQ(keys("paper-2"), wanted);
  wanted.insert("suture.bend_damping");
  for (const char* model : {"paper-3", "paper-4", "paper-5"}) EXPECT_EQ(keys(model), wanted) << model;
  options.overrides = {"contact.solver=none"};
  EXPECT_EQ(desk().offer().parameters[0].key, "suture.stretch_N") << "without contact there is no friction";
}

TEST_F(SceneDeskTest, FrictionMayBeRaisedToThePapers) {
  auto d = desk();
  ASSERT_FALSE(d.request(set("contact.friction", 10.0), true).has_value());
  const auto o = outcome(d);
  ASSERT_EQ(o.ack.accepted, 1) << o.ack.reason;
  EXPECT_NE(o.changed->toml.find("# --set contact.friction=10"), std::string::npos) << o.changed->toml;
}

TEST_F(SceneDeskTest, LoadsAScene) {
  auto d = desk();
  ASSERT_FALSE(d.request(load("longer.toml", 7), false).has_value());
  const auto o = outcome(d);
  EXPECT_EQ(o.ack.id, 7);
  EXPECT_EQ(o.ack.accepted, 1) << o.ack.reason;
  ASSERT_TRUE(o.changed.has_value());
  EXPECT_EQ(o.changed->radius_m, 0.04);
  EXPECT_NE(o.changed->toml.find("nodes = 20"), std::string::npos);
}

TEST_F(SceneDeskTest, RefusesWithTheReason) {
  auto d = desk();
  const auto in_force = d.request(load("longer.toml"), true);
  ASSERT_TRUE(in_force.has_value());
  EXPECT_EQ(in_force->accepted, 0);
  EXPECT_NE(in_force->reason.find("disarm first"), std::string::npos);
  for (const char* name : {"none.toml", "../small.toml", "/etc/passwd", ""}) {
    const auto ack = d.request(load(name), false);
    ASSERT_TRUE(ack.has_value()) << name;
    EXPECT_NE(ack->reason.find("allowed"), std::string::npos);
  }
  EXPECT_NE(d.request(set("suture.nodes", 12.0), false)->reason.find("no such parameter"), std::string::npos);
  EXPECT_NE(d.request(set("contact.friction", 10.1), false)->reason.find("allowed 0 .. 10"), std::string::npos);
  EXPECT_NE(d.request(set("contact.friction", std::nan("")), false)->reason.find("allowed"), std::string::npos);
}

TEST_F(SceneDeskTest, RefusesASceneThatIsWrongOrDoesNotFit) {
  auto d = desk();
  ASSERT_FALSE(d.request(load("wrong.toml"), false).has_value());
  const auto wrong = outcome(d);
  EXPECT_EQ(wrong.ack.accepted, 0);
  EXPECT_NE(wrong.ack.reason.find("suture.nodes"), std::string::npos) << wrong.ack.reason;
  ASSERT_FALSE(d.request(load("small.toml"), false).has_value()) << "and takes the next";
  EXPECT_EQ(outcome(d).ack.accepted, 1);
}

TEST_F(SceneDeskTest, ParametersAddUpAndAreWrittenIntoTheScenesText) {
  auto d = desk();
  ASSERT_FALSE(d.request(set("contact.friction", 0.5), true).has_value()) << "also while force flows";
  EXPECT_EQ(outcome(d).ack.accepted, 1);
  ASSERT_FALSE(d.request(set("hands.force_scale", 0.006), true).has_value());
  const auto o = outcome(d);
  ASSERT_TRUE(o.changed.has_value()) << o.ack.reason;
  EXPECT_NE(o.changed->toml.find("# --set contact.friction=0.5"), std::string::npos);
  EXPECT_NE(o.changed->toml.find("# --set hands.force_scale=0.006"), std::string::npos);
  EXPECT_EQ(d.offer().parameters[0].value, 0.5);
  EXPECT_EQ(d.offer().parameters.back().value, 0.006);
}

TEST_F(SceneDeskTest, OneAtATimeAndTheLoopHasTheLastWord) {
  auto d = desk();
  ASSERT_FALSE(d.request(load("longer.toml", 1), false).has_value());
  const auto second = d.request(load("small.toml", 2), false);
  ASSERT_TRUE(second.has_value());
  EXPECT_NE(second->reason.find("under way"), std::string::npos);
  EXPECT_FALSE(d.request(load("longer.toml", 1), false).has_value()) << "the same, sent again, gets the one answer";
  const auto o = outcome(d, false);
  EXPECT_EQ(o.ack.accepted, 0);
  EXPECT_FALSE(o.changed.has_value());
}

TEST_F(SceneDeskTest, WhatTheLaunchSetStaysSetWhateverIsLoaded) {
  options.overrides = {"hands.max_force_N=1.0", "suture.nodes=12"};
  auto d = desk();
  for (const char* wish : {"longer.toml", "small.toml suture.model=paper-2", "longer.toml"}) {
    ASSERT_FALSE(d.request(load(wish), false).has_value()) << wish;
    const auto o = outcome(d);
    ASSERT_EQ(o.ack.accepted, 1) << o.ack.reason;
    EXPECT_EQ(hands.max_force_N, 1.0) << wish;
    EXPECT_EQ(o.changed->max_force_N, 1.0) << wish;
    EXPECT_EQ(nodes, 12) << wish;
    EXPECT_NE(o.changed->toml.find("\n# --set hands.max_force_N=1.0\n"), std::string::npos) << o.changed->toml;
    for (const auto& text : {o.ack.reason, o.changed->text})
      EXPECT_NE(text.find("launch options hold: --set hands.max_force_N=1.0, --set suture.nodes=12"), text.npos)
          << text;
  }
}

TEST_F(SceneDeskTest, ASceneMayAskForLessForceThanTheLaunchAllows) {
  write("soft.toml", "[suture]\nnodes = 10\n[hands]\nmax_force_N = 0.5\n");
  for (const char* launch : {"hands.max_force_N=1.0", "hands={max_force_N=1.0}"}) {
    options.overrides = {launch};
    auto d = desk();
    ASSERT_FALSE(d.request(load("soft.toml"), false).has_value());
    EXPECT_EQ(outcome(d).ack.accepted, 1);
    EXPECT_EQ(hands.max_force_N, 0.5) << launch;
    ASSERT_FALSE(d.request(load("longer.toml"), false).has_value());
    EXPECT_EQ(outcome(d).ack.accepted, 1);
    EXPECT_EQ(hands.max_force_N, 1.0) << launch << ": and no later scene may ask for more";
  }
}

TEST_F(SceneDeskTest, ALiveValueYieldsToTheLaunchsAtTheNextScene) {
  options.overrides = {"contact.friction=0.4"};
  auto d = desk();
  ASSERT_FALSE(d.request(set("contact.friction", 0.5), true).has_value());
  const auto o = outcome(d);
  ASSERT_TRUE(o.changed.has_value()) << o.ack.reason;
  EXPECT_NE(o.changed->toml.find("# --set contact.friction=0.5"), std::string::npos);
  EXPECT_EQ(o.changed->toml.find("# --set contact.friction=0.4"), std::string::npos)
      << "the text says what is in force";
  ASSERT_FALSE(d.request(load("longer.toml"), false).has_value());
  EXPECT_EQ(outcome(d).ack.accepted, 1);
  EXPECT_EQ(d.offer().parameters[0].value, 0.4);
}

TEST_F(SceneDeskTest, NoMessageTurnsTheForceUpBeyondTheLaunch) {
  options.overrides = {"hands.force_scale=0.002"};
  auto d = desk();
  const auto beyond = d.request(set("hands.force_scale", 0.003), false);
  ASSERT_TRUE(beyond.has_value());
  EXPECT_NE(beyond->reason.find("--set hands.force_scale=0.002"), std::string::npos) << beyond->reason;
  EXPECT_EQ(d.offer().parameters.back().highest, 0.002);
  ASSERT_FALSE(d.request(set("hands.force_scale", 0.001), false).has_value()) << "down it may go,";
  EXPECT_EQ(outcome(d).ack.accepted, 1);
  ASSERT_FALSE(d.request(set("hands.force_scale", 0.002), false).has_value()) << "and up again to where it was";
  EXPECT_EQ(outcome(d).ack.accepted, 1);
}

TEST_F(SceneDeskTest, AStiffCouplingOnceTakenIsTakenToTheEnd) {
  write("stiff.toml", "[suture]\nnodes = 10\n[hands]\ndevice_N_per_m = 9000.0\n");
  options.scene = (folder / "stiff.toml").string();
  options.override_passivity = true;
  auto d = desk();
  ASSERT_FALSE(d.request(set("contact.friction", 0.5), true).has_value());
  const auto o = outcome(d);
  EXPECT_EQ(o.ack.accepted, 1) << o.ack.reason;
  ASSERT_FALSE(d.request(load("stiff.toml"), false).has_value());
  const auto again = outcome(d);
  EXPECT_EQ(again.ack.accepted, 1) << again.ack.reason;
  EXPECT_NE(again.ack.reason.find("--override-passivity"), std::string::npos) << again.ack.reason;
}

TEST_F(SceneDeskTest, LoadsASceneWithAnotherNumberOfNodes) {
  options.overrides = {"suture.nodes=12"};
  auto d = desk();
  ASSERT_FALSE(d.request(load("longer.toml suture.nodes=15 suture.model=paper-2"), false).has_value());
  EXPECT_EQ(outcome(d).ack.accepted, 1);
  EXPECT_EQ(nodes, 15);
  ASSERT_FALSE(d.request(set("contact.friction", 0.5), false).has_value());
  const auto o = outcome(d);
  EXPECT_EQ(nodes, 15) << "a parameter leaves it as it is";
  EXPECT_NE(o.changed->toml.find("# --set suture.model=paper-2"), std::string::npos) << o.changed->toml;
  ASSERT_FALSE(d.request(load("longer.toml"), false).has_value());
  EXPECT_EQ(outcome(d).ack.accepted, 1);
  EXPECT_EQ(nodes, 12) << "the launch's, again";
  for (const char* bad : {"longer.toml suture.nodes=1", "longer.toml suture.nodes=many"}) {
    ASSERT_FALSE(d.request(load(bad), false).has_value());
    EXPECT_NE(outcome(d).ack.reason.find("allowed integer 2 .. 5000"), std::string::npos) << bad;
  }
  for (const char* bad : {"longer.toml hands.max_force_N=3.3", "longer.toml suture.nodes=9 hands.max_force_N=3.3"})
    EXPECT_NE(d.request(load(bad), false)->reason.find("allowed suture.model=MODEL and suture.nodes=N"),
              std::string::npos)
        << bad;
}

}  // namespace
}  // namespace ligature::app
