// The host's programs can read the recordings of the virtual rig, which runs in one process.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <fstream>
#include <sstream>

#include "host/errors.hpp"
#include "host/export.hpp"
#include "host/knot_command.hpp"
#include "tests/integration/virtual_rig/scenes.hpp"
#include "tests/integration/virtual_rig/simulated_rig.hpp"
#include "tests/support/temp_folder.hpp"

namespace ligature {
namespace {

/// An operator that holds both tools at their start and then draws the right one aside; stores what it perceives.
class Drawer final : public lab::SeeingOperator {
 public:
  std::array<sim::Vec3, 2> start_W_m() const override { return {sim::Vec3(0.2, 0, 3.0), sim::Vec3(0.2, 0, 1.5)}; }
  std::array<sim::HandWish, 2> act(const sim::Sight& sight) override {
    times.push_back(sight.t_s);
    nodes = sight.thread_W.size();
    felt_N = std::max(felt_N, sight.force_W_N[1].norm());
    tool = sight.tool_W[1];
    const auto start = start_W_m();
    const double s = std::clamp((sight.t_s - 0.2) / 1.5, 0.0, 1.0);
    const sim::Vec3 v = s > 0.0 && s < 1.0 ? sim::Vec3(2.0, 0, 0) : sim::Vec3(0, 0, 0);
    return {sim::HandWish{start[0], sim::Vec3::Zero(), false}, {start[1] + sim::Vec3(3.0 * s, 0, 0), v, true}};
  }
  bool is_done() const override { return !times.empty() && times.back() > 2.0; }

  std::vector<double> times;
  std::size_t nodes = 0;
  double felt_N = 0.0;
  sim::Vec3 tool = sim::Vec3::Zero();
};

std::string bytes_of(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

TEST(RigRecording, ASeeingOperatorSeesEachMillisecondFeelsAndEnds) {
  Drawer drawer;
  lab::VirtualRig rig({.scene = paper()}, drawer);
  ASSERT_EQ(rig.run(20000, true), std::nullopt);
  EXPECT_TRUE(rig.is_done());
  EXPECT_LT(rig.records.size(), 3500U);
  ASSERT_GT(drawer.times.size(), 2000U);
  for (std::size_t i = 1; i < 2000; ++i) ASSERT_NEAR(drawer.times[i] - drawer.times[i - 1], 1e-3, 1e-9) << i;
  EXPECT_EQ(drawer.nodes, rig.thread.nodes_W().size());
  EXPECT_GT(drawer.felt_N, 0.1);
  // The simulated fingers yield to the thread's pull, by millimetres at the device.
  EXPECT_NEAR(drawer.tool.x(), 3.2, 0.1);
}

TEST(RigRecording, TheHostReadsEveryTickAndNamesTheKnot) {
  const std::string log = test::temp_folder() + "run.lcmlog", ticks = test::temp_folder() + "ticks.csv";
  const auto hands = std::get<scene::GripperScript>(scene::load_gripper_script(kScenes + "operators/overhand.csv"));
  SimulatedRig rig(paper(), hands);
  rig.record(log);
  ASSERT_EQ(rig.run(23000), std::nullopt);
  const auto exported = host::export_recording(log, {.csv = {"", "", ticks}});
  EXPECT_EQ(exported.tick_rows, static_cast<std::int64_t>(rig.records.size()));
  EXPECT_EQ(exported.missing, 0);
  EXPECT_EQ(exported.unreadable_messages, 0);
  host::KnotOptions options;
  options.file = log;
  EXPECT_EQ(host::describe_knot(options).substr(0, 3), "3_1") << host::describe_knot(options);
}

TEST(RigRecording, AFullDiskEndsTheRunAndIsSaid) {  // the error must not abort the program
  Drawer drawer;
  lab::VirtualRig rig({.scene = paper()}, drawer);
  rig.record(test::temp_folder() + "full.lcmlog");
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit full{300'000, before.rlim_max};  // file size limit in bytes
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &full), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  std::string said = "nothing";
  try {
    (void)rig.run(20000, true);
  } catch (const host::RunFailed& error) {
    said = error.what();
  }
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_NE(said.find("full.lcmlog: writing failed"), std::string::npos) << said;
  EXPECT_LT(rig.records.size(), 3000U) << "it ends there";
  EXPECT_EQ(rig.controller.state(), control::State::kOff) << "with the drives off";
}

TEST(RigRecording, TwoRunsWithLostFramesWriteTheSameBytes) {
  const auto run = [&](const std::string& name, std::uint64_t seed) {
    Drawer drawer;
    lab::VirtualRig rig({.scene = paper(), .frame_loss = 0.05, .seed = seed}, drawer);
    rig.record(test::temp_folder() + name);
    EXPECT_EQ(rig.run(1200), std::nullopt);
    EXPECT_GT(rig.left.frames_lost + rig.right.frames_lost, 300);
    return bytes_of(test::temp_folder() + name);
  };
  const std::string a = run("a.lcmlog", 4), b = run("b.lcmlog", 4), c = run("c.lcmlog", 5);
  EXPECT_TRUE(a == b);
  EXPECT_FALSE(a == c);
}

}  // namespace
}  // namespace ligature
