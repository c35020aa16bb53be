#include "host/lab/run_files.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

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

TEST(CsvFile, LeavesTheOlderOneUntilItIsWhole) {
  const std::filesystem::path path = test::temp_folder() + "older.csv";
  std::ofstream(path) << "old";
  { const CsvFile killed(path, "a"); }
  EXPECT_EQ(text_of(path), "old");
  CsvFile file(path, "a");
  file.finish();
  EXPECT_EQ(text_of(path), "old");
  file.close();
  EXPECT_EQ(text_of(path), "a\n");
  {
    CsvFile finished(path, "b");
    finished.finish();
  }
  EXPECT_EQ(text_of(path), "a\n");
  EXPECT_FALSE(std::filesystem::exists(path.string() + ".part"));
}

TEST(RemoveOldOutputs, LeavesWhatIsNotOurs) {
  const std::filesystem::path folder = test::temp_folder() + "old_outputs";
  std::filesystem::create_directories(folder);
  for (const char* name : {"summary.json", "trace.csv", "shape.csv", "notes.txt"})
    std::ofstream(folder / name) << "old";
  remove_old_outputs(folder, {"summary.json", "trace.csv", "shape.csv"});
  EXPECT_FALSE(std::filesystem::exists(folder / "summary.json"));
  EXPECT_FALSE(std::filesystem::exists(folder / "trace.csv"));
  EXPECT_TRUE(std::filesystem::exists(folder / "notes.txt"));
  std::filesystem::remove_all(folder);
}

TEST(RemoveOldOutputs, RemovesNoneWhenOneIsNoFile) {
  const std::filesystem::path folder = test::temp_folder() + "no_file";
  std::filesystem::create_directories(folder / "shape.csv");
  std::ofstream(folder / "trace.csv") << "old";
  EXPECT_THROW(check_outputs(folder, {"trace.csv", "shape.csv"}), Refusal);
  EXPECT_THROW(remove_old_outputs(folder, {"trace.csv", "shape.csv"}), Refusal);
  EXPECT_TRUE(std::filesystem::exists(folder / "trace.csv"));
  EXPECT_NO_THROW(check_outputs(folder, {"trace.csv", "absent.csv"}));
}

std::string file_refusal(const std::filesystem::path& path) {
  try {
    static_cast<void>(checked_file("--out", path));
  } catch (const Refusal& refusal) {
    EXPECT_EQ(refusal.code, kBadInput);
    return refusal.what();
  }
  return "taken";
}

TEST(CheckedFile, IsANewOrARegularFileInAFolder) {
  const std::filesystem::path folder = test::temp_folder() + "checked";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "there") << "old";
  std::filesystem::create_symlink("there", folder / "link");
  std::filesystem::create_symlink("nothing", folder / "loose");
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(checked_file("--out", folder / "new"), folder / "new");
  EXPECT_EQ(checked_file("--out", folder / "link"), std::filesystem::canonical(folder / "there"));
  EXPECT_EQ(file_refusal("new"), "taken");
  EXPECT_NE(file_refusal(folder).find("found a folder, allowed a new or a regular file"), std::string::npos);
  EXPECT_NE(file_refusal(".").find("--out .: found a folder"), std::string::npos);
  EXPECT_NE(file_refusal(folder / "pipe").find("found a device, pipe or socket"), std::string::npos);
  EXPECT_NE(file_refusal("/dev/null").find("found a device, pipe or socket"), std::string::npos);
  EXPECT_NE(file_refusal(folder / "loose").find("found a link to nothing"), std::string::npos);
  EXPECT_NE(file_refusal(folder / "no" / "new").find("found no folder"), std::string::npos);
  EXPECT_EQ(text_of(folder / "there"), "old");
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
