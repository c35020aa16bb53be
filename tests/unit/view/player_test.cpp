#include "host/view/player.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "tests/unit/host/synthetic_log.hpp"
#include "tests/unit/view/frames.hpp"

namespace ligature::host::view {
namespace {

using test_frames::Read;
using namespace std::chrono_literals;

/// 40 s: a straight thread until 20 s, then an overhand knot; the right hand grasps at 10 s.
struct Recording {
  test::TestFolder folder;
  std::string path = folder.file("run.lcmlog");

  Recording() {
    LogWriter log(path, false);
    for (int i = 0; i < 2000; ++i) {
      const std::int64_t utime = 1'000'000 + 20'000LL * i;
      auto batch = test::batch_of(1, 20 * i, 20);
      batch.utime = utime;
      test::write(log, kTicksChannel, batch);
      auto thread = test::thread_of(20 * i, i < 1000 ? test::straight_points(60) : test::overhand_points(60));
      thread.utime = utime;
      test::write(log, kThreadChannel, thread);
      if (i != 500) continue;
      ligature_msg::event_t event{};
      event.utime = utime;
      event.kind = ligature_msg::event_t::KIND_GRASP;
      event.text = "right grasps node 3";
      test::write(log, kEventChannel, event);
    }
    log.close();
  }
};

struct Playing {
  Recording recording;
  LogMap map{recording.path};
  LogSurvey survey{map};
  Picture picture;
  Player player{map, survey, picture};
  Picture::Clock::time_point now = Picture::Clock::now();
  Place page;

  Read frame() { return Read(picture.frame_for(page, nlohmann::json::array(), now)); }
  void wait_for_survey() const {
    while (survey.progress() < 1.0) std::this_thread::yield();
  }
};

TEST(Player, GoesAtItsSpeedAndStandsWhenHeld) {
  Playing p;
  p.player.advance(p.now);
  EXPECT_TRUE(p.player.request({{"speed", 10}}, p.now).is_null());
  const double before_s = p.player.position_s();
  p.player.advance(p.now += 100ms);
  EXPECT_NEAR(p.player.position_s() - before_s, 1.0, 1e-9);
  EXPECT_EQ(p.frame().ticks().back() / 20, static_cast<std::int64_t>(p.map.after(p.player.position_s()) / 2 - 1));
  EXPECT_TRUE(p.player.request({{"play", false}}, p.now).is_null());
  p.player.advance(p.now += 100ms);
  EXPECT_NEAR(p.player.position_s() - before_s, 1.0, 1e-9);
}

TEST(Player, JumpsAndShowsWhatLedThere) {
  Playing p;
  (void)p.frame();
  EXPECT_TRUE(p.player.request({{"seek_s", 30.0}}, p.now).is_null());
  const auto told = p.frame();
  // Tick number of the newest tick, the last of the batch at 30 s.
  EXPECT_EQ(told.doubles(Section::kNow)[2], 20.0 * 1500 + 19);
  EXPECT_EQ(told.doubles(Section::kShape)[0], 20.0 * 1500);
  EXPECT_GE(told.ticks().front(), 18'000);
  EXPECT_TRUE(p.player.request({{"seek_s", -5}}, p.now).is_null());
  EXPECT_EQ(p.player.position_s(), 0.0);
}

TEST(Player, RefusesWhatARecordingCannot) {
  Playing p;
  EXPECT_EQ(p.player.request({{"speed", 11}}, p.now)["accepted"], false);
  EXPECT_EQ(p.player.request({{"speed", 0}}, p.now)["accepted"], false);
  EXPECT_EQ(p.player.request({{"command", "arm"}}, p.now)["accepted"], false);
}

TEST(LogSurvey, TheOverviewOfAShortRecordingHasNoHoles) {
  const test::TestFolder folder;
  LogWriter log(folder.file("short.lcmlog"), false);
  for (int i = 0; i < 50; ++i) {  // one second: twelve columns of the overview for each message
    auto batch = test::batch_of(1, 20 * i, 20);
    batch.utime = 1'000'000 + 20'000LL * i;
    for (auto& tick : batch.ticks) tick.f_device_N[0][2] = 1.0;
    test::write(log, kTicksChannel, batch);
  }
  log.close();
  const LogMap map(folder.file("short.lcmlog"));
  const LogSurvey survey(map);
  while (survey.progress() < 1.0) std::this_thread::yield();
  EXPECT_EQ(survey.marks()["left_N"], nlohmann::json(std::vector<float>(LogSurvey::kOverview, 1.0F)));
}

TEST(LogSurvey, FindsGraspAndKnotAndTheSameEachTime) {
  Playing p;
  p.wait_for_survey();
  const auto marks = p.survey.marks()["marks"];
  ASSERT_EQ(marks.size(), 2U) << marks;
  EXPECT_EQ(marks[0]["text"], "right grasps node 3");
  EXPECT_NEAR(marks[0]["t_s"].get<double>(), 10.0, 1e-9);
  EXPECT_TRUE(marks[1]["text"].get<std::string>().starts_with("knot 3_1"));
  EXPECT_NEAR(marks[1]["t_s"].get<double>(), 20.0, LogSurvey::kKnotPeriod_s);
  const LogSurvey again(p.map);
  while (again.progress() < 1.0) std::this_thread::yield();
  EXPECT_EQ(again.marks(), p.survey.marks());
}

/// Two recordings are aligned by their first grasp: by either hand and at any node, the first node included.
TEST(LogSurvey, FindsTheFirstGraspOfEitherHandAtAnyNode) {
  for (const int hand : {0, 1}) {
    const test::TestFolder folder;
    const std::string path = folder.file("grasp.lcmlog");
    LogWriter log(path, false);
    for (int i = 0; i < 10; ++i) {
      auto batch = test::batch_of(1, 20 * i, 20);
      for (auto& tick : batch.ticks)
        if (tick.tick >= 87) tick.grasped_node[hand] = 0;
      test::write(log, kTicksChannel, batch);
    }
    log.close();
    const LogMap map(path);
    const LogSurvey survey(map);
    while (survey.progress() < 1.0) std::this_thread::yield();
    EXPECT_EQ(survey.landmarks().first_tick, 0) << hand;
    EXPECT_EQ(survey.landmarks().first_grasp, 87) << hand;
  }
}

TEST(LogSurvey, GivesTheBinsBeforeAMoment) {
  Playing p;
  p.wait_for_survey();
  const auto bins = p.survey.history(20.0);
  ASSERT_FALSE(bins.empty());
  EXPECT_EQ(bins.front().low[kTick], 0.0F);
  EXPECT_NEAR(static_cast<double>(bins.back().low[kTick]) * kTicksPerBin * 1e-3, 20.0, 0.1);
}

}  // namespace
}  // namespace ligature::host::view
