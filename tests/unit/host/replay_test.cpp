// A fixed recording gives the same knots at the same ticks, the same events and the same traces, at any replay speed
// and after any jumps.
#include <gtest/gtest.h>

#include <thread>

#include "host/thread_knot.hpp"
#include "host/view/comparison.hpp"
#include "host/view/log_map.hpp"
#include "host/view/log_survey.hpp"
#include "host/view/player.hpp"
#include "host/view/rig_json.hpp"
#include "synthetic_log.hpp"

namespace ligature::host::view {
namespace {

using nlohmann::json;
using Clock = Picture::Clock;
constexpr std::int64_t kSession = 1'700'000'000'000'000;
constexpr int kTicks = 6000, kBatch = 20;

ligature_msg::event_t event_of(std::int64_t tick, std::int8_t kind, int code, const std::string& text) {
  ligature_msg::event_t event{};
  event.utime = kSession + tick * 1000;
  event.tick = tick, event.kind = kind, event.hand = 0, event.code = code, event.text = text;
  return event;
}

/// Writes a recording of 6 s: a straight thread, an overhand knot from 2 s on, straight again from 5 s on; a hand
/// grasps it from tick `grasp` on.
void write_golden(const std::string& path, std::int64_t grasp) {
  LogWriter log(path, false);
  ligature_msg::status_t status{};
  status.utime = kSession, status.session = kSession, status.period_s = 1e-3;
  test::write(log, kStatusChannel, status);
  for (int first = 0; first < kTicks; first += kBatch) {
    auto batch = test::batch_of(kSession, first, kBatch);
    for (auto& tick : batch.ticks) {
      tick.grasped_node[0] = static_cast<std::int16_t>(tick.tick >= grasp ? 7 : -1);
      tick.f_device_N[0][0] = 0.1 * static_cast<double>(tick.tick % 13) / 3.0;
    }
    test::write(log, kTicksChannel, batch);
    if (first % 100 == 0) {
      auto thread =
          test::thread_of(first, first >= 2000 && first < 5000 ? test::overhand_points(60) : test::straight_points(60));
      thread.utime = batch.utime;
      test::write(log, kThreadChannel, thread);
    }
    if (first == grasp / kBatch * kBatch)
      test::write(log, kEventChannel, event_of(grasp, ligature_msg::event_t::KIND_GRASP, 7, "left hand holds node 7"));
    if (first == 4000)
      test::write(log, kEventChannel, event_of(4000, ligature_msg::event_t::KIND_FAULT, 30, "fault 30"));
  }
  log.close();
}

struct Seen {
  std::vector<std::string> knots;  // e.g. "3_1 right"; one entry per change
  std::vector<std::pair<std::int64_t, std::string>> events;
  std::int64_t last_tick = -1;
};

std::uint32_t u32_at(const std::vector<std::byte>& bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// Contents of all sections of one kind in a frame.
std::vector<std::vector<std::byte>> sections(const std::vector<std::byte>& frame, Section kind) {
  std::vector<std::vector<std::byte>> found;
  for (std::size_t at = 8; at + 8 <= frame.size();) {
    const std::size_t size = u32_at(frame, at + 4), start = at + 8;
    if (u32_at(frame, at) == static_cast<std::uint32_t>(kind))
      found.emplace_back(frame.begin() + static_cast<std::ptrdiff_t>(start),
                         frame.begin() + static_cast<std::ptrdiff_t>(start + size));
    at = start + (size + 7) / 8 * 8;
  }
  return found;
}

void look(Picture& picture, Place& place, std::int64_t& known, Seen& seen, Clock::time_point now) {
  if (const auto shape = picture.newer_shape(known); shape && shape->count > 0) {
    const auto knot = name_knot(*shape);
    const std::string name = knot.type + " " + knot.handedness;
    if (seen.knots.empty() || seen.knots.back() != name) seen.knots.push_back(name);
  }
  const auto frame = picture.frame_for(place, json::array(), now);
  for (const auto& text : sections(frame, Section::kText)) {
    const auto told = json::parse(reinterpret_cast<const char*>(text.data()),
                                  reinterpret_cast<const char*>(text.data()) + text.size());
    if (told.contains("events"))
      for (const auto& e : told["events"])
        seen.events.emplace_back(e["tick"].get<std::int64_t>(), e["text"].get<std::string>());
  }
  for (const auto& rows : sections(frame, Section::kRows)) {
    double tick = 0.0;
    std::memcpy(&tick, rows.data() + rows.size() - sizeof(TraceRow), sizeof tick);
    seen.last_tick = static_cast<std::int64_t>(tick);
  }
}

class Replay : public ::testing::Test {
 protected:
  void SetUp() override { write_golden(path_, 1234); }

  void wait_for(const LogSurvey& survey) {
    while (survey.progress() < 1.0) std::this_thread::yield();
  }

  Seen played(double speed) {
    const LogMap map(path_);
    const LogSurvey survey(map);
    Picture picture;
    Player player(map, survey, picture);
    Clock::time_point now{};
    player.seek(0.0, now);
    EXPECT_TRUE(player.request({{"speed", speed}}, now).is_null());
    Seen seen;
    Place place;
    std::int64_t known = 0;
    for (int round = 0; round < 100'000 && player.is_playing(); ++round) {
      now += std::chrono::milliseconds(16);
      player.advance(now);
      look(picture, place, known, seen, now);
    }
    return seen;
  }

  test::TestFolder folder_;
  std::string path_ = folder_.file("golden.lcmlog");
};

TEST_F(Replay, ShowsTheSameKnotsAndEventsAtAnySpeed) {
  const std::vector<std::string> knots{"0_1 none", "3_1 left", "0_1 none"};
  const std::vector<std::pair<std::int64_t, std::string>> events{{1234, "left hand holds node 7"}, {4000, "fault 30"}};
  for (const double speed : {0.5, 1.0, 10.0}) {
    const Seen seen = played(speed);
    EXPECT_EQ(seen.knots, knots) << speed;
    EXPECT_EQ(seen.events, events) << speed;
    EXPECT_EQ(seen.last_tick, kTicks - 1) << speed;
  }
}

TEST_F(Replay, MarksAreTheSameEvents) {
  const LogMap map(path_);
  const LogSurvey survey(map);
  wait_for(survey);
  std::vector<std::pair<std::string, double>> marks;
  const auto found = survey.marks();
  for (const auto& mark : found["marks"])
    marks.emplace_back(mark["text"].get<std::string>(), mark["t_s"].get<double>());
  ASSERT_EQ(marks.size(), 4U);
  const std::vector<std::pair<std::string, double>> golden{
      {"left hand holds node 7", 1.234}, {"knot 3_1 left", 2.0}, {"fault 30", 4.0}, {"knot 0_1 none", 5.0}};
  for (std::size_t i = 0; i < golden.size(); ++i) {
    EXPECT_EQ(marks[i].first, golden[i].first);
    // While surveying a log, knots are looked for only once per kKnotPeriod_s.
    EXPECT_NEAR(marks[i].second, golden[i].second, LogSurvey::kKnotPeriod_s) << golden[i].first;
  }
  EXPECT_EQ(survey.landmarks().first_tick, 0);
  EXPECT_EQ(survey.landmarks().first_grasp, 1234);
}

/// A second recording is shown beside the first, both aligned at their first grasp: what the page receives of it, and
/// its position.
TEST_F(Replay, AnotherRecordingRunsBesideItFromTheCommonGrasp) {
  write_golden(folder_.file("other.lcmlog"), 2000);
  const LogMap map(path_);
  const LogSurvey survey(map);
  wait_for(survey);
  Picture picture;
  Comparison comparison(survey, picture, folder_.path());
  EXPECT_FALSE(comparison.request({{"compare", "../golden.lcmlog"}, {"align", "grasp"}})["accepted"].get<bool>());
  EXPECT_FALSE(comparison.request({{"compare", "other.lcmlog"}, {"align", "middle"}})["accepted"].get<bool>());
  EXPECT_TRUE(comparison.request({{"compare", "other.lcmlog"}, {"align", "grasp"}}).is_null());

  Player player(map, survey, picture);
  const Clock::time_point now{};
  player.seek(1.5, now);
  Place place;
  json told;
  double last = -1.0;
  for (int round = 0; round < 1'000'000 && last < 2200.0; ++round) {
    comparison.follow(player.position_s(), now);
    const auto frame = picture.frame_for(place, json::array(), now);
    for (const auto& text : sections(frame, Section::kText)) {
      const auto all = json::parse(reinterpret_cast<const char*>(text.data()),
                                   reinterpret_cast<const char*>(text.data()) + text.size());
      if (all.contains("compare")) told = all["compare"];
    }
    for (const auto& rows : sections(frame, Section::kBesideRows))
      std::memcpy(&last, rows.data() + rows.size() - sizeof(TraceRow), sizeof last);
  }
  EXPECT_EQ(told["files"], (json{"golden.lcmlog", "other.lcmlog"}));
  EXPECT_EQ(told["offset_ticks"], 1234 - 2000);
  // The recording is at 1.5 s, 0.266 s after its first grasp. The other recording must be as far after its own first
  // grasp, to within a batch.
  EXPECT_NEAR(last, 2266.0, 2 * kBatch);

  EXPECT_TRUE(comparison.request({{"compare", ""}, {"align", "start"}}).is_null());
  EXPECT_TRUE(sections(picture.frame_for(place, json::array(), now), Section::kBeside).empty());
}

}  // namespace
}  // namespace ligature::host::view
