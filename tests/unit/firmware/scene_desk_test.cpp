// Changes while the rig runs: what is refused, with which words, and that what is lent comes back.
#include "firmware/app/scene_desk.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <thread>

namespace ligature::app {
namespace {

namespace fs = std::filesystem;
using ligature_msg::command_t;

class SceneDeskTest : public ::testing::Test {
 protected:
  SceneDeskTest() {
    fs::create_directories(folder);
    write("small.toml", "[suture]\nnodes = 10\n[world]\nfixed = [{node = 0, position_m = [0.0, 0.0, 5.5]}]\n");
    write("longer.toml",
          "[suture]\nnodes = 20\nradius_m = 0.04\n[world]\nfixed = [{node = 0, position_m = [0.0, 0.0, 5.5]}]\n");
    write("wrong.toml", "[suture]\nnodes = 1\n");
    write("huge.toml", "[suture]\nnodes = 5000\nlength_m = 50.0\nradius_m = 0.003\n");
    options.scene = (folder / "small.toml").string();
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    options.force = true;  // admission measures a program that a sanitizer slows down
#endif
  }
  ~SceneDeskTest() override { fs::remove_all(folder); }
  void write(const std::string& name, const std::string& text) const { std::ofstream(folder / name) << text; }

  static command_t load(const std::string& name, std::int64_t id = 1) {
    command_t c{};
    c.id = id, c.kind = command_t::KIND_LOAD_SCENE, c.text = name;
    return c;
  }
  static command_t set(const std::string& key, double value, std::int64_t id = 1) {
    command_t c{};
    c.id = id, c.kind = command_t::KIND_SET_PARAMETER, c.text = key, c.value = value;
    return c;
  }
  SceneDesk desk() const { return SceneDesk(options, std::get<Plan>(make_plan(options.scene, {})), 0); }

  /// Plays the loop until the desk has answered.
  static SceneDesk::Outcome outcome(SceneDesk& desk, bool takes = true) {
    for (;;) {
      if (auto* plant = desk.handover().take()) {
        plant->taken = takes;
        desk.handover().give_back(plant);
      }
      if (auto o = desk.poll()) return *o;
      std::this_thread::yield();
    }
  }

  const fs::path folder = fs::temp_directory_path() / ("ligature-desk-" + std::to_string(getpid()));
  RunOptions options;
};

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
  EXPECT_NE(d.request(set("contact.friction", 2.1), false)->reason.find("allowed 0 .. 2"), std::string::npos);
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

TEST(Rehearsal, FindsAThreadThatWouldBlowUp) {
  scene::Scene s;
  s.suture.nodes = 20;
  s.suture.paper.integrator = scene::Integrator::kForward;
  s.suture.paper.damping = scene::Damping::kExplicit;
  s.suture.paper.stretch_N = 8e4;
  auto made = physics::Simulation::make(s);
  ASSERT_TRUE(std::holds_alternative<physics::Simulation>(made)) << std::get<std::string>(made);
  EXPECT_NE(rehearse(std::get<physics::Simulation>(made)).find("unstable"), std::string::npos);
  EXPECT_EQ(rehearse(std::get<physics::Simulation>(physics::Simulation::make(scene::Scene{}))), "");
}

}  // namespace
}  // namespace ligature::app
