// The trace of `export --trace`: what the format demands, and the times of the recording.
#include "host/export_trace.hpp"

#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "host/errors.hpp"
#include "host/export.hpp"
#include "synthetic_log.hpp"

namespace ligature::host {
namespace {

using Json = nlohmann::json;
constexpr std::int64_t kPeriodNs = 1'000'000, kZeroNs = 7'000'000'123;

ligature_msg::tick_t busy_tick(std::int64_t number) {
  auto tick = test::tick_of(number);
  tick.scheduled_ns = kZeroNs + number * kPeriodNs;
  tick.wakeup_latency_ns = 20'000 + static_cast<int>(number);
  tick.sync_ns = 15'000;
  tick.tpdo_ns = 460'000;
  tick.law_ns = 470'500;
  tick.control_ns = 490'000;
  tick.execution_ns = 495'250;
  tick.thread_start_ns = 510'000;
  tick.thread_done_ns = 900'000;
  tick.bus_load[0] = 0.5F;
  return tick;
}

class ExportTrace : public ::testing::Test {
 protected:
  Json trace_of(std::vector<ligature_msg::tick_t> ticks, TraceTarget target = {}) {
    LogWriter log(folder_.file("a.lcmlog"), true);
    ligature_msg::status_t status{};
    status.session = 1;
    status.period_s = 1e-3;
    test::write(log, kStatusChannel, status);
    ligature_msg::tick_batch_t batch{};
    batch.session = 1;
    batch.count = static_cast<std::int32_t>(ticks.size());
    batch.ticks = std::move(ticks);
    test::write(log, kTicksChannel, batch);
    ligature_msg::event_t event{};
    event.tick = 2;
    event.text = "fault 11 \"late\"";
    test::write(log, kEventChannel, event);
    log.close();
    target.path = folder_.file("a.json");
    ExportTargets targets;
    targets.trace = target;
    export_recording(folder_.file("a.lcmlog"), targets);
    return Json::parse(test::text_of(target.path));
  }

  /// Slices with this name, in order.
  static std::vector<Json> slices(const Json& trace, const std::string& name) {
    std::vector<Json> found;
    for (const auto& event : trace.at("traceEvents"))
      if (event.at("ph") == "X" && event.at("name") == name) found.push_back(event);
    return found;
  }

  test::TestFolder folder_;
};

TEST_F(ExportTrace, EveryEventHasWhatTheFormatDemands) {
  const Json trace = trace_of({busy_tick(0), busy_tick(1), busy_tick(2)});
  std::map<std::string, int> kinds;
  for (const auto& event : trace.at("traceEvents")) {
    const std::string kind = event.at("ph");
    ++kinds[kind];
    EXPECT_TRUE(event.at("name").is_string());
    EXPECT_TRUE(event.at("ts").is_number());
    EXPECT_EQ(event.at("pid"), 1);
    if (kind == "X") {
      EXPECT_GE(event.at("dur").get<double>(), 0.0) << event;
    } else if (kind == "C") {
      for (const auto& value : event.at("args")) EXPECT_TRUE(value.is_number());
    } else if (kind == "i") {
      EXPECT_EQ(event.at("s"), "p");
    }
  }
  EXPECT_EQ(kinds["C"], 3);
  EXPECT_EQ(kinds["i"], 1);
  EXPECT_EQ(kinds["M"], 5);
  EXPECT_EQ(kinds.size(), 4U);
}

TEST_F(ExportTrace, SlicesOfATrackNestOrFollowEachOther) {
  const Json trace = trace_of({busy_tick(0), busy_tick(1), busy_tick(2), busy_tick(3)});
  std::map<int, std::vector<std::pair<double, double>>> tracks;
  for (const auto& event : trace.at("traceEvents"))
    if (event.at("ph") == "X") {
      const double begin = event.at("ts");
      tracks[event.at("tid").get<int>()].emplace_back(begin, begin + event.at("dur").get<double>());
    }
  EXPECT_EQ(tracks.size(), 3U);
  constexpr double kRounding_us = 1e-6;
  for (const auto& [track, spans] : tracks)
    for (std::size_t i = 0; i < spans.size(); ++i)
      for (std::size_t j = i + 1; j < spans.size(); ++j) {
        const auto& [a, b] = spans[i];
        const auto& [c, d] = spans[j];
        const bool apart = b <= c + kRounding_us || d <= a + kRounding_us;
        const bool nested = (a <= c && d <= b + kRounding_us) || (c <= a && b <= d + kRounding_us);
        EXPECT_TRUE(apart || nested) << "track " << track << ": " << a << ".." << b << " and " << c << ".." << d;
      }
}

TEST_F(ExportTrace, PhasesHaveTheTimesOfTheRecordingToTheNanosecond) {
  const auto tick = busy_tick(2);
  const Json trace = trace_of({busy_tick(0), busy_tick(1), tick});
  const double awake_us = static_cast<double>(tick.scheduled_ns + tick.wakeup_latency_ns) * 1e-3;
  const std::map<std::string, std::pair<double, double>> wanted{
      {"wake-up", {awake_us - tick.wakeup_latency_ns * 1e-3, tick.wakeup_latency_ns * 1e-3}},
      {"tick", {awake_us, 495.25}},
      {"SYNC", {awake_us, 15.0}},
      {"wait for joints", {awake_us + 15.0, 445.0}},
      {"coupling and limits", {awake_us + 460.0, 10.5}},
      {"send torques", {awake_us + 470.5, 19.5}},
      {"hand over to physics", {awake_us + 490.0, 5.25}},
      {"physics", {awake_us + 510.0, 390.0}}};
  for (const auto& [name, times] : wanted) {
    auto found = slices(trace, name);
    if (name == "wake-up") std::erase_if(found, [](const Json& slice) { return slice.at("tid") != 1; });
    ASSERT_EQ(found.size(), 3U) << name;
    EXPECT_NEAR(found[2].at("ts"), times.first, 1e-3 / 2) << name;
    EXPECT_NEAR(found[2].at("dur"), times.second, 1e-6) << name;
  }
  for (const auto& event : trace.at("traceEvents"))
    if (event.at("ph") == "i") {
      EXPECT_NEAR(event.at("ts"), static_cast<double>(tick.scheduled_ns) * 1e-3, 1e-3 / 2);
      EXPECT_EQ(event.at("name"), "fault 11 \"late\"");
    }
}

TEST_F(ExportTrace, ALostPeriodIsOneSliceAndALateTickSaysSo) {
  auto lost = busy_tick(1), late = busy_tick(2);
  lost.flags = ligature_msg::tick_t::FLAG_PERIOD_LOST;
  late.flags = ligature_msg::tick_t::FLAG_DEADLINE_MISSED;
  late.thread_done_ns = 0;  // the physics was not done
  const Json trace = trace_of({busy_tick(0), lost, late});
  ASSERT_EQ(slices(trace, "period lost").size(), 1U);
  EXPECT_NEAR(slices(trace, "period lost")[0].at("dur"), 1000.0, 1e-6);
  EXPECT_EQ(slices(trace, "tick").size(), 1U);
  EXPECT_EQ(slices(trace, "tick, too late").size(), 1U);
  EXPECT_EQ(slices(trace, "physics").size(), 1U);
}

TEST_F(ExportTrace, ASpanLeavesTheRestOut) {
  const Json trace =
      trace_of({busy_tick(0), busy_tick(1), busy_tick(2), busy_tick(3)}, {.path = "", .from_s = 1e-3, .to_s = 2e-3});
  ASSERT_EQ(slices(trace, "tick").size(), 2U);
  EXPECT_EQ(slices(trace, "tick")[0].at("args").at("tick"), 1);
}

}  // namespace
}  // namespace ligature::host
