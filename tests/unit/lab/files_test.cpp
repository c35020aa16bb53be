#include "host/lab/run_files.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <sstream>

#include "host/lab/outcome.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/unit/lab/text_of.hpp"

namespace ligature::lab {
namespace {

TEST(CsvFile, NumbersReadBackExactly) {
  const std::filesystem::path path = test::temp_folder() + "numbers.csv";
  const double cells[] = {0.1, -1e-300, 3.0, 1.0 / 3.0};
  CsvFile file(path, "a,b,c,d");
  file.row(cells);
  file.close();
  EXPECT_EQ(text_of(path), "a,b,c,d\n0.1,-1e-300,3,0.3333333333333333\n");
}

TEST(CsvFile, RefusesAPlaceItCannotWrite) {
  EXPECT_THROW(CsvFile("no/such/folder/x.csv", "a"), Refusal);
  EXPECT_THROW(make_folder("/proc/no"), Refusal);
}

TEST(CsvFile, HasItsNameOnlyWhenComplete) {
  const std::filesystem::path path = test::temp_folder() + "complete.csv";
  std::filesystem::remove(path);
  {
    CsvFile killed(path, "a");
    EXPECT_FALSE(std::filesystem::exists(path));
  }
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_FALSE(std::filesystem::exists(path.string() + ".part"));
  CsvFile file(path, "a");
  file.close();
  EXPECT_TRUE(std::filesystem::exists(path));
}

TEST(RemoveOldOutputs, LeavesWhatIsNotOurs) {
  const std::filesystem::path folder = test::temp_folder() + "old_outputs";
  std::filesystem::create_directories(folder);
  for (const char* name : {"summary.json", "trace.csv", "shape.csv", "notes.txt"})
    std::ofstream(folder / name) << "old";
  remove_old_outputs(folder);
  EXPECT_FALSE(std::filesystem::exists(folder / "summary.json"));
  EXPECT_FALSE(std::filesystem::exists(folder / "trace.csv"));
  EXPECT_TRUE(std::filesystem::exists(folder / "notes.txt"));
  std::filesystem::remove_all(folder);
}

TEST(WriteText, LeavesNoPartBehind) {
  const std::filesystem::path path = test::temp_folder() + "summary.json";
  write_text(path, "{}\n");
  EXPECT_EQ(text_of(path), "{}\n");
  EXPECT_FALSE(std::filesystem::exists(path.string() + ".part"));
}

TEST(TraceRow, KnowsWhenItIsNotFinite) {
  TraceRow row;
  EXPECT_TRUE(row.is_finite());
  row.right_N.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(row.is_finite());
  row = {};
  row.min_gap_m = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(row.is_finite());
}

}  // namespace
}  // namespace ligature::lab
