// The cost of each setting against its error, over all published cases.

#include "host/lab/published/front.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "host/lab/outcome.hpp"
#include "tests/support/temp_folder.hpp"

namespace ligature::published {
namespace {

constexpr const char* kHeader = "case,setting,ticks,tick_us,error_tolerances,judged,missed\n";

std::filesystem::path folder_with(const std::string& text) {
  std::filesystem::path folder = test::temp_folder() + "front";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "front.csv") << text;
  return folder;
}

const Overall& of(const std::vector<Overall>& all, const std::string& setting) {
  return *std::ranges::find(all, setting, &Overall::setting);
}

TEST(PublishedFront, SumsUpCasesThatEverySettingHas) {
  const std::vector<FrontRow> rows{{"ply", "fast", 10, 40, 0.5, 4, 0},
                                   {"ply", "fine", 10, 200, 0.1, 4, 0},
                                   {"capstan", "fast", 900, 60, 3.0, 6, 2},
                                   {"capstan", "fine", 900, 100, 0.9, 6, 0},
                                   {"cyclic", "fast", 9e6, 9000, 50, 90, 90}};  // not run at fine
  const auto all = over_all_cases(rows);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(of(all, "fast").cases, 2.0);
  EXPECT_EQ(of(all, "fast").cases_met, 1.0);
  EXPECT_EQ(of(all, "fast").judged, 10.0);
  EXPECT_EQ(of(all, "fast").missed, 2.0);
  EXPECT_DOUBLE_EQ(of(all, "fast").tick_us, 50.0);  // each case counts once, however long it is
  EXPECT_DOUBLE_EQ(of(all, "fine").tick_us, 150.0);
}

TEST(PublishedFront, HasTheSettingsThatNoOtherBeats) {
  const auto all = over_all_cases({{"ply", "fast", 1, 10, 1, 9, 3},
                                   {"ply", "worse", 1, 20, 1, 9, 4},
                                   {"ply", "twin", 1, 20, 1, 9, 2},
                                   {"ply", "dear", 1, 30, 1, 9, 2},
                                   {"ply", "fine", 1, 40, 1, 9, 0}});
  for (const char* best : {"fast", "twin", "fine"}) EXPECT_TRUE(of(all, best).on_front) << best;
  for (const char* beaten : {"worse", "dear"}) EXPECT_FALSE(of(all, beaten).on_front) << beaten;
}

TEST(PublishedFront, IsReadAsWritten) {
  const auto rows = read_front(folder_with(std::string(kHeader) + "post,balanced 10 M,1200,81.5,inf,7,2\n"));
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].examined, "post");
  EXPECT_EQ(rows[0].setting, "balanced 10 M");
  EXPECT_EQ(rows[0].tick_us, 81.5);
  EXPECT_TRUE(std::isinf(rows[0].worst));
  EXPECT_EQ(rows[0].missed, 2.0);
}

TEST(PublishedFront, AFileThatIsNoneIsRefusedWithItsLine) {
  for (const char* row : {"post,fine,1,nan,0,7,2\n", "post,fine,1,5,0,7,inf\n", "post,fine,1,-5,0,7,2\n"}) {
    try {
      static_cast<void>(read_front(folder_with(std::string(kHeader) + row)));
      ADD_FAILURE() << row;
    } catch (const lab::Refusal& refusal) {
      EXPECT_NE(std::string(refusal.what()).find("front.csv:2: found '"), std::string::npos) << refusal.what();
    }
  }
  EXPECT_THROW(static_cast<void>(read_front(test::temp_folder() + "no such folder")), lab::Refusal);
}

TEST(PublishedFront, SettingsHaveNamesWithoutACommaOfTheirOwn) {
  const auto settings = settings_of("all", {10'000'000});
  ASSERT_EQ(settings.size(), 4U);
  for (const auto& s : settings) EXPECT_EQ(s.name.find(','), std::string::npos) << s.name;
}

}  // namespace
}  // namespace ligature::published
