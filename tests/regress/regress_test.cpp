// The cheap scenes of `ligature-lab regress` must give the figures of expected.csv; the comparison of the two is
// tested, too.

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "host/lab/outcome.hpp"
#include "host/lab/regress/expected.hpp"
#include "ligature_source_dir.hpp"

namespace ligature::regress {
namespace {

const Bench kBench{std::string(LIGATURE_SOURCE_DIR) + "/scenes"};

Expectations expected() { return read_expected(embedded_expected(), "expected.csv"); }

// A change to the physics that moves a figure beyond its tolerance must be looked at; `ligature-lab regress --update`
// accepts it.
TEST(Regress, CheapScenesAreWithinTheirTolerances) {
  const auto known = expected();
  for (const auto& scene : all_scenes()) {
    if (!scene.cheap) continue;
    const auto lines = compare({{scene.name, scene.measure(kBench)}}, known);
    EXPECT_FALSE(lines.empty()) << scene.name;
    for (const auto& line : lines) {
      EXPECT_TRUE(line.verdict == Verdict::kSame || line.verdict == Verdict::kMoved)
          << line.scene << ", " << line.figure << ": " << line.measured << " for " << line.expected.value << " +- "
          << line.expected.tolerance << ": " << name(line.verdict);
    }
  }
}

TEST(Regress, TheFileHasEverySceneAndNoOther) {
  std::set<std::string> scenes, in_file;
  for (const auto& scene : all_scenes()) EXPECT_TRUE(scenes.insert(scene.name).second) << scene.name;
  for (const auto& [key, value] : expected()) in_file.insert(key.first);
  EXPECT_EQ(scenes, in_file);
}

TEST(Regress, AFigureIsSameMovedBeyondNewOrGone) {
  const auto known = read_expected(
      "# a comment\nscene,figure,expected,tolerance\ns,a,1,0.1\ns,b (m),2,0.1\ns,c,3,0\n"
      "s,gone,1,1\nother,a,1,1\n",
      "file");
  const auto lines = compare({{"s", {{"a", 1.0}, {"b (m)", 2.05}, {"c", 3.001}, {"new", 1.0}}}}, known);
  ASSERT_EQ(lines.size(), 5U);
  EXPECT_EQ(lines[0].verdict, Verdict::kSame);
  EXPECT_EQ(lines[1].verdict, Verdict::kMoved);
  EXPECT_EQ(lines[2].verdict, Verdict::kBeyond);
  EXPECT_EQ(lines[3].verdict, Verdict::kNew);
  EXPECT_EQ(lines[4].verdict, Verdict::kGone);
  EXPECT_EQ(compare({{"s", {{"a", std::nan("")}}}}, known)[0].verdict, Verdict::kBeyond);
}

TEST(Regress, AnUpdateKeepsTolerancesAndReadsBackAsTheSame) {
  const Measured measured{{"s", {{"a, in mm", 1.0 / 3.0, 5.0}, {"b", 1e-7, 0.5}}}};
  const auto before = read_expected("s,\"ignored\",1,1\ns,a, in mm,7,0.25\n", "file");
  const auto after = read_expected(write_expected(measured, before), "file");
  ASSERT_EQ(after.size(), 2U);
  EXPECT_EQ(after.at({"s", "a, in mm"}).tolerance, 0.25);
  EXPECT_EQ(after.at({"s", "b"}).tolerance, 0.5);
  for (const auto& line : compare(measured, after)) EXPECT_EQ(line.verdict, Verdict::kSame) << line.figure;
}

TEST(Regress, RefusesAFileThatItDoesNotUnderstand) {
  EXPECT_THROW((void)read_expected("s,a,1\n", "file"), lab::Refusal);
  EXPECT_THROW((void)read_expected("s,a,one,1\n", "file"), lab::Refusal);
  EXPECT_THROW((void)read_expected("s,a,1,-1\n", "file"), lab::Refusal);
  EXPECT_THROW((void)read_expected("s,a,1,1\ns,a,2,1\n", "file"), lab::Refusal);
}

}  // namespace
}  // namespace ligature::regress
