#include "host/lab/report.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "host/lab/outcome.hpp"
#include "host/lab/script_moves.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/unit/lab/text_of.hpp"

namespace ligature::lab {
namespace {

TEST(Verdict, FailsWhenOneClaimDoes) {
  const std::filesystem::path folder = test::temp_folder();
  Verdict v("sample");
  v.claim(true, "the sky, seen from below", "blue", "blue");
  EXPECT_EQ(v.conclude(folder), kDone);
  v.claim(false, "pigs", "walk", "fly");
  EXPECT_EQ(v.conclude(folder), kRunFailed);
  EXPECT_EQ(text_of(folder / "sample-verdict.csv"),
            "verdict,claim,measured,allowed\nPASS,\"the sky, seen from below\",blue,blue\nFAIL,pigs,walk,fly\n");
}

TEST(Table, KeepsNumbersAndTexts) {
  const std::filesystem::path path = test::temp_folder() + "table.csv";
  Table t({"name", "value"});
  t.row({std::string("a"), 0.125});
  t.write(path);
  EXPECT_EQ(text_of(path), "name,value\na,0.125\n");
}

TEST(Draw, SaysSoAndGoesOnWhenThereIsNoPython) {
  setenv("LIGATURE_PYTHON", "/no/such/python", 1);
  ::testing::internal::CaptureStdout();
  draw("bench.py", {"bench.csv"}, "bench.png");
  EXPECT_NE(::testing::internal::GetCapturedStdout().find("no picture bench.png"), std::string::npos);
  unsetenv("LIGATURE_PYTHON");
}

TEST(ScriptMoves, KeepTimesGripsAndDistances) {
  scene::GripperScript script;
  script.keys[1] = {{0.0, {1, 2, 3}, true}, {2.0, {4, 5, 6}, false}};
  EXPECT_EQ(mirrored(script).keys[1][0].p_W_m, (scene::Vec{-1, 2, 3}));
  EXPECT_EQ(mirrored(mirrored(script)).keys[1][1].p_W_m, script.keys[1][1].p_W_m);
  const auto quarter = turned(script, 1.5707963267948966);
  EXPECT_NEAR(quarter.keys[1][0].p_W_m[0], -2.0, 1e-12);
  EXPECT_NEAR(quarter.keys[1][0].p_W_m[1], 1.0, 1e-12);
  EXPECT_EQ(paced(script, 2.0).keys[1][1].time_s, 1.0);
  EXPECT_EQ(release_time_s(script), 2.0);
}

}  // namespace
}  // namespace ligature::lab
