#include "host/lab/run.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include "host/lab/outcome.hpp"
#include "ligature_source_dir.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/unit/lab/text_of.hpp"

namespace ligature::lab {
namespace {

const std::string kScene = LIGATURE_SOURCE_DIR "/scenes/paper.toml";
const std::string kOverhand = LIGATURE_SOURCE_DIR "/scenes/operators/overhand.csv";

std::vector<std::string> lines_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

TEST(Run, WritesOneTraceRowATickAndShapesOnTime) {
  Rehearsal r(load_scene_or_refuse(kScene, {"suture.nodes=20"}), {});
  const std::filesystem::path folder = test::temp_folder() + "run_files";
  const auto s = run(r, {folder, 0.105, 0.02});
  EXPECT_EQ(s.ticks, 105);
  EXPECT_TRUE(s.finite);
  EXPECT_EQ(s.knot.type, "0_1");
  EXPECT_EQ(lines_of(folder / "trace.csv").size(), 1u + 105u);
  const auto shape = lines_of(folder / "shape.csv");
  EXPECT_EQ(shape.size(), 1u + 20u * (1 + 5 + 1));  // shapes at the start, every 20 ms, and at the end
  EXPECT_EQ(shape.back().substr(0, 9), "0.105,19,");
  EXPECT_TRUE(std::filesystem::exists(folder / "summary.json"));
}

TEST(Run, TheOverhandScriptTiesATrefoilThatStays) {
  for (const char* nodes : {"suture.nodes=35", "suture.nodes=50"}) {
    Rehearsal r(load_scene_or_refuse(kScene, {nodes, "contact.friction=0.3"}), load_script_or_refuse(kOverhand));
    ASSERT_TRUE(r.run_until(21.0));
    EXPECT_EQ(knot_of(r.simulation()).type, "3_1") << nodes << " at release";
    ASSERT_TRUE(r.run_until(30.0));
    EXPECT_EQ(knot_of(r.simulation()).type, "3_1") << nodes << " nine seconds after";
  }
}

TEST(Run, ADivergingRunNamesTickNodeAndCauseAndWritesNothingNonFinite) {
  Rehearsal r(load_scene_or_refuse(kScene, {"time.tick_s=0.05", "suture.integrator=forward"}), {});
  const std::filesystem::path folder = test::temp_folder() + "run_diverged";
  const auto s = run(r, {folder, 500.0, 10.0});
  ASSERT_FALSE(s.finite);
  EXPECT_NE(s.failure.find("diverged at tick"), std::string::npos) << s.failure;
  EXPECT_NE(s.failure.find("node "), std::string::npos);
  EXPECT_NE(s.failure.find("likely cause: "), std::string::npos);
  for (const char* name : {"trace.csv", "shape.csv", "summary.json"}) {
    for (const auto& line : lines_of(folder / name)) {
      EXPECT_EQ(line.find("nan"), std::string::npos) << name << ": " << line;
      EXPECT_EQ(line.find("inf"), std::string::npos) << name << ": " << line;
    }
  }
}

TEST(Run, AHandThatIsNoNumberIsNamedAndNoStiffness) {
  for (const char* scene : {"paper.toml", "suture-3-0.toml"}) {
    auto script = load_script_or_refuse(kOverhand);
    for (auto& key : script.keys[0]) key.p_W_m[0] = std::numeric_limits<double>::quiet_NaN();
    Rehearsal r(load_scene_or_refuse(std::string(LIGATURE_SOURCE_DIR "/scenes/") + scene, {}), script);
    const auto s = run(r, {test::temp_folder() + "run_no_hand", 0.1, 0.1});
    EXPECT_FALSE(s.finite);
    EXPECT_EQ(s.failure,
              "diverged at tick 0 (t = 0.001 s), by a hand whose position or speed is no number, or beyond 1e9");
  }
}

TEST(Run, ARefusedOneLeavesTheFilesOfAnEarlierRun) {
  Rehearsal r(load_scene_or_refuse(kScene, {"suture.nodes=20"}), {});
  const std::filesystem::path folder = test::temp_folder() + "run_refused";
  std::filesystem::create_directories(folder / "shape.csv");
  for (const char* name : {"trace.csv", "summary.json"}) std::ofstream(folder / name) << "old";
  EXPECT_THROW((void)run(r, {folder, 0.01, 0.01}), Refusal);
  EXPECT_EQ(r.ticks(), 0);
  EXPECT_EQ(text_of(folder / "trace.csv"), "old");
  EXPECT_EQ(text_of(folder / "summary.json"), "old");
  std::filesystem::remove(folder / "shape.csv");
  (void)run(r, {folder, 0.01, 0.01});
  EXPECT_EQ(lines_of(folder / "trace.csv").size(), 1u + 10u);
}

TEST(Run, RefusesBeforeItWrites) {
  EXPECT_THROW((void)load_scene_or_refuse("no/such.toml", {}), Refusal);
  EXPECT_THROW((void)load_script_or_refuse("no/such.csv"), Refusal);
}

}  // namespace
}  // namespace ligature::lab
