// The rehearsal of a scene: a child process tries the scene before the loop gets it. Tested: how a rehearsal can end,
// and what the child gets.
#include "firmware/app/rehearsal.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <iterator>

#include "firmware/app/rehearsal_process.hpp"
#include "tests/unit/firmware/scene_desk_fixture.hpp"

namespace ligature::app {
namespace {

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
