#include <gtest/gtest.h>

#include <array>
#include <string>

#include "host/console/progress.hpp"

namespace ligature::console {
namespace {

using std::chrono::milliseconds;

class ProgressLine : public ::testing::Test {
 protected:
  ~ProgressLine() override { std::fclose(out_); }
  std::string written() {
    EXPECT_EQ(std::fseek(out_, 0, SEEK_SET), 0);
    std::array<char, 500> text{};
    return {text.data(), std::fread(text.data(), 1, text.size(), out_)};
  }
  std::FILE* out_ = std::tmpfile();
  Progress::Clock::time_point start_{};
};

TEST_F(ProgressLine, SaysHowFarAndHowLongAndWipesItself) {
  {
    Progress progress("export", out_, true, start_);
    EXPECT_FALSE(progress.is_due(start_ + milliseconds(900)));  // no progress is shown for short work
    EXPECT_TRUE(progress.is_due(start_ + milliseconds(2000)));
    EXPECT_FALSE(progress.is_due(start_ + milliseconds(2100)));  // too soon after the previous one
    progress.show(0.25, "", start_ + milliseconds(2000));
    progress.show(0.5, "N = 50", start_ + milliseconds(3000));
  }
  EXPECT_EQ(written(), "\rexport: 25 %, about 6 s more\033[K\rexport: 50 %, about 3 s more (N = 50)\033[K\r\033[K");
}

TEST_F(ProgressLine, IsSilentWhereNobodyWatches) {
  {
    Progress progress("export", out_, false, start_);
    progress.show(0.5, "", start_ + milliseconds(5000));
  }
  EXPECT_EQ(written(), "");
}

}  // namespace
}  // namespace ligature::console
