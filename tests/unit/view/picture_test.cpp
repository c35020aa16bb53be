#include "host/view/picture.hpp"

#include <gtest/gtest.h>

#include "tests/unit/host/synthetic_log.hpp"
#include "tests/unit/view/frames.hpp"

namespace ligature::host::view {
namespace {

using test_frames::Read;
using namespace std::chrono_literals;
const Picture::Clock::time_point kStart{};

template <class M>
void take(Picture& picture, std::string_view channel, const M& message, Picture::Clock::time_point now = kStart) {
  std::vector<std::byte> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  picture.take(channel, bytes, now);
}

Read frame(const Picture& picture, Place& place, Picture::Clock::time_point now = kStart) {
  return Read(picture.frame_for(place, nlohmann::json::array(), now));
}

TEST(Picture, TellsEachPageEachTickOnce) {
  Picture picture;
  Place page;
  take(picture, kTicksChannel, test::batch_of(1, 0, 20));
  EXPECT_EQ(frame(picture, page).ticks().size(), 20U);
  EXPECT_TRUE(frame(picture, page).ticks().empty());
  take(picture, kTicksChannel, test::batch_of(1, 20, 20));
  take(picture, kTicksChannel, test::batch_of(1, 20, 20));  // delivered twice by the network
  EXPECT_EQ(frame(picture, page).ticks().front(), 20);
  Place late;
  EXPECT_EQ(frame(picture, late).ticks().size(), 40U);
}

/// Each page gets each trace bin (summary of some ticks) once, at any request rate, also when all bins come at once.
TEST(Picture, TellsEachPageEachBinOnce) {
  for (const int batches_a_frame : {7, 5000}) {  // 5000: more bins than fit in a frame
    Picture picture;
    Place page;
    std::vector<std::int64_t> told;
    const auto ask = [&] {
      const auto bins = frame(picture, page).bins();
      told.insert(told.end(), bins.begin(), bins.end());
      return !bins.empty();
    };
    constexpr int kManyBatches = 5000;
    for (int i = 0; i < kManyBatches; ++i) {
      take(picture, kTicksChannel, test::batch_of(1, 20 * i, 20));
      if (i % batches_a_frame == 0) ask();
    }
    while (ask()) {
    }
    ASSERT_EQ(std::ssize(told), 20 * kManyBatches / kTicksPerBin - 1)
        << batches_a_frame;  // the last bin is not complete
    for (std::size_t i = 0; i < told.size(); ++i) ASSERT_EQ(told[i], static_cast<std::int64_t>(i)) << batches_a_frame;
  }
}

TEST(Picture, GivesAPageThatFellBehindTheLatest) {
  Picture picture;
  Place page;
  take(picture, kTicksChannel, test::batch_of(1, 0, 20));
  (void)frame(picture, page);
  for (int i = 20; i < 40'000; i += 20) take(picture, kTicksChannel, test::batch_of(1, i, 20));
  const auto told = frame(picture, page);
  EXPECT_EQ(told.ticks().size(), static_cast<std::size_t>(Picture::kRowsPerFrame));
  EXPECT_EQ(told.ticks().back(), 39'999);
  EXPECT_TRUE(told.sections.contains(Section::kBins));  // ticks that are not in the frame are summarised in trace bins
}

TEST(Picture, BoundsEveryFrame) {
  Picture picture;
  for (int i = 0; i < 100'000; i += 20) take(picture, kTicksChannel, test::batch_of(1, i, 20));
  Place page;
  for (int i = 0; i < 20; ++i)
    EXPECT_LT(picture.frame_for(page, nlohmann::json::array(), kStart).size(), std::size_t{1} << 20U);
}

TEST(Picture, StartsAgainWithANewRunOfTheFirmware) {
  Picture picture;
  Place page;
  take(picture, kTicksChannel, test::batch_of(1, 5000, 20));
  const auto before = frame(picture, page).doubles(Section::kNow)[0];
  take(picture, kTicksChannel, test::batch_of(2, 0, 20));
  const auto after = frame(picture, page);
  EXPECT_NE(after.doubles(Section::kNow)[0], before);
  EXPECT_EQ(after.ticks().front(), 0);
}

TEST(Picture, SaysHowOldItIs) {
  Picture picture;
  Place page;
  EXPECT_EQ(frame(picture, page).doubles(Section::kNow)[1], -1.0);
  take(picture, kTicksChannel, test::batch_of(1, 0, 20));
  EXPECT_DOUBLE_EQ(frame(picture, page, kStart + 170ms).doubles(Section::kNow)[1], 170.0);
  picture.hold(kStart + 1s);
  EXPECT_DOUBLE_EQ(frame(picture, page, kStart + 1s).doubles(Section::kNow)[1], 0.0);
}

TEST(Picture, TellsATopicWhenItChanges) {
  Picture picture;
  Place page;
  picture.set("knot", {{"type", "3_1"}});
  EXPECT_EQ(frame(picture, page).text()["knot"]["type"], "3_1");
  EXPECT_FALSE(frame(picture, page).text().contains("knot"));
  picture.set("knot", {{"type", "0_1"}});
  EXPECT_EQ(frame(picture, page).text()["knot"]["type"], "0_1");
}

TEST(Picture, SurvivesWhatIsNoMessage) {
  Picture picture;
  Place page;
  const std::vector<std::byte> noise(300, std::byte{0xA5});
  for (const auto channel : {kTicksChannel, kThreadChannel, kStatusChannel, kEventChannel})
    picture.take(channel, noise, kStart);
  auto huge = test::thread_of(1, test::straight_points(10));
  huge.p_W_m[3][0] = std::numeric_limits<float>::quiet_NaN();
  take(picture, kThreadChannel, huge);
  EXPECT_EQ(picture.unreadable(), 5);
  EXPECT_FALSE(frame(picture, page).sections.contains(Section::kShape));
}

}  // namespace
}  // namespace ligature::host::view
