// SceneDesk handles commands that change scene or parameters during a run: which are rejected, with which messages, and
// that it gets back what it hands to the loop.
#include "firmware/app/scene_desk.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <thread>

#include "firmware/app/rehearsal.hpp"
#include "firmware/app/rehearsal_process.hpp"
#include "firmware/app/scene_preview.hpp"
#include "firmware/platform/sanitized.hpp"
#include "protocol/scene/scene_file.hpp"

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
    options.program = LIGATURE_FIRMWARE;
#ifdef LIGATURE_SANITIZED
    options.force = true;  // a sanitizer slows the program down, so admission would fail
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
  SceneDesk desk() const { return SceneDesk(options, std::get<Plan>(make_plan(options))); }

  /// Acts as the loop until the desk has answered. @param takes whether the loop accepts what the desk offers.
  SceneDesk::Outcome outcome(SceneDesk& desk, bool takes = true) {
    for (;;) {
      if (auto* plant = desk.handover().take()) {
        plant->taken = takes;
        plant->first_tick = 1234;
        hands = plant->hands;
        nodes = static_cast<int>(plant->thread.nodes_W().size());
        desk.handover().give_back(plant);
      }
      if (auto o = desk.poll()) return *o;
      std::this_thread::yield();
    }
  }

  const fs::path folder = fs::temp_directory_path() / ("ligature-desk-" + std::to_string(getpid()));
  RunOptions options;
  scene::Hands hands;  // as handed to the loop last
  int nodes = 0;
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

TEST_F(SceneDeskTest, PreviewsSayWhatASceneIsWithTheLaunchsOverrides) {
  options.overrides = {"suture.length_m=4.0"};
  const auto offer = desk().offer();
  ASSERT_EQ(offer.previews.size(), offer.scenes.size());
  EXPECT_EQ(offer.previews[1].facts, "paper-4, 20 nodes, 4 m long, 80 mm thick, fixed at 1 node, grippers collide");
  EXPECT_TRUE(std::isnan(offer.previews[1].desk_height_m));
  EXPECT_EQ(offer.previews[3].point_count, 0) << "wrong.toml";
  EXPECT_EQ(offer.previews[3].about, (folder / "wrong.toml:2: key 'suture.nodes': found 1, allowed integer 2 .. 5000"));
}

// The preview simulates nothing, so its shape is compared with that of the physics.
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

/// Writes a shell script that takes the place of the rehearsal: the child process that tries out a scene.
std::string script(const fs::path& folder, const std::string& body) {
  const auto path = folder / "program.sh";
  std::ofstream(path) << "#!/bin/sh\n" << body << "\n";
  fs::permissions(path, fs::perms::owner_all);
  return path.string();
}

TEST_F(SceneDeskTest, ASceneThatTakesItsRehearsalDownIsRefusedAndNothingElseHappens) {
  const std::pair<const char*, const char*> ends[] = {{"kill -SEGV $$", "took the process of its rehearsal down (Segm"},
                                                      {"kill -ABRT $$", "took the process of its rehearsal down (Abor"},
                                                      {"kill -XCPU $$", "the rehearsal took too long"},
                                                      {"exit 1", "took the process of its rehearsal down (exit code 1"},
                                                      {"exit 2", "no reason given"}};
  for (const auto& [body, words] : ends) {
    options.program = script(folder, body);
    auto d = desk();
    for (const auto& wish : {load("longer.toml"), set("contact.friction", 0.5)}) {
      ASSERT_FALSE(d.request(wish, false).has_value()) << body << ": and the next request is heard";
      const auto o = outcome(d);
      EXPECT_EQ(o.ack.accepted, 0) << body;
      EXPECT_NE(o.ack.reason.find(words), std::string::npos) << o.ack.reason;
    }
  }
  options.program = (folder / "none").string();
  auto d = desk();
  ASSERT_FALSE(d.request(load("longer.toml"), false).has_value());
  EXPECT_NE(outcome(d).ack.reason.find("cannot be rehearsed: no process"), std::string::npos);
}

TEST_F(SceneDeskTest, TellsOfEachSceneWhetherItFitsAndSinceWhichTick) {
  options.program = script(folder, "case \"$3\" in *longer*) echo ligature-firmware: too much >&2; exit 3;; esac");
  options.force = false;  // also in a sanitized build: this program measures nothing
  {
    auto strict = desk();
    ASSERT_FALSE(strict.request(load("longer.toml"), false).has_value());
    EXPECT_EQ(outcome(strict).ack.reason, "too much");
  }
  options.force = true;
  SceneDesk d(options, std::get<Plan>(make_plan(options)), "too much at the start");
  const auto changed = [&](const ligature_msg::command_t& wish) {
    EXPECT_FALSE(d.request(wish, false).has_value());
    return *outcome(d).changed;
  };
  const auto first = changed(set("contact.friction", 0.5));
  EXPECT_FALSE(first.admitted) << "a parameter leaves it as it was";
  EXPECT_NE(first.toml.find("\n# --force: too much at the start\n"), std::string::npos) << first.toml;
  EXPECT_EQ(first.first_tick, 1234);
  const auto fits = changed(load("small.toml"));
  EXPECT_TRUE(fits.admitted);
  EXPECT_EQ(fits.toml.find("--force"), std::string::npos) << fits.toml;
  for (const auto& wish : {load("longer.toml"), set("contact.friction", 0.5)}) {
    const auto large = changed(wish);
    EXPECT_FALSE(large.admitted);
    EXPECT_NE(large.toml.find("\n# --force: too much\n"), std::string::npos) << large.toml;
  }
}

TEST_F(SceneDeskTest, ARehearsalThatDoesNotEndIsEndedWithTheDesk) {
  const auto note = folder / "pid";
  options.program = script(folder, "echo $$ > " + note.string() + "; exec sleep 600");
  int pid = 0;
  {
    auto d = desk();
    ASSERT_FALSE(d.request(load("longer.toml"), false).has_value());
    for (; pid == 0; std::this_thread::yield()) std::ifstream(note) >> pid;
  }
  EXPECT_NE(kill(pid, 0), 0) << "it is gone, and waited for";
}

TEST(RehearsalProcess, IsEndedWhenItsTimeIsOver) {
  const std::atomic<bool> cancelled{false};
  const auto path = script(fs::temp_directory_path(), "exec sleep 600");
  Rehearsal what;
  what.program = path, what.file = "a.toml", what.patience = std::chrono::milliseconds(50);
  const auto v = rehearse_elsewhere(what, cancelled);
  EXPECT_EQ(v.refusal, "a.toml: the rehearsal did not end in time and was ended");
  fs::remove(path);
}

// What the child process gets: the scene text as read, the overrides, and no file descriptors but its three.
TEST_F(SceneDeskTest, TheRehearsalHasTheTextAndNoFileOfOurs) {
  options.overrides = {"hands.max_force_N=1.0"};
  const auto at = [&](const char* name) { return (folder / name).string(); };
  constexpr int kOurs = 40;
  ASSERT_EQ(dup2(STDERR_FILENO, kOurs), kOurs) << "LCM does not close its socket on exec";
  options.program =
      script(folder, "cat > " + at("text") + "; echo \"$@\" > " + at("words") + "; ls /proc/$$/fd > " + at("files"));
  auto d = desk();
  ASSERT_FALSE(d.request(load("longer.toml suture.nodes=15"), false).has_value());
  EXPECT_EQ(outcome(d).ack.accepted, 1);
  const auto all = [&](const char* name) {
    std::ifstream file(at(name));
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  EXPECT_EQ(all("text"), all("longer.toml"));
  EXPECT_EQ(all("words"), "rehearse --scene " + at("longer.toml") +
                              " --text-from /proc/self/fd/0 --set hands.max_force_N=1.0 --set "
                              "suture.nodes=15\n");
  EXPECT_NE(all("files").find("2\n"), std::string::npos);
  EXPECT_EQ(all("files").find("40\n"), std::string::npos) << all("files");
  close(kOurs);
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
