#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>

#include "host/errors.hpp"
#include "host/log_summary.hpp"
#include "host/names.hpp"
#include "host/report.hpp"
#include "synthetic_log.hpp"

namespace ligature::host {
namespace {

/// Writes two seconds in batches of 20 ticks, without the batch at 0.4 s; a shape every 20 ms; a knot from 1.5 s on.
std::string write_run(const test::TestFolder& folder) {
  const std::string path = folder.file("run.lcmlog");
  LogWriter log(path, false);
  ligature_msg::status_t status{};
  status.period_s = 1e-3;
  status.max_force_N = 3.3;
  status.scene_file = "scenes/paper.toml";
  test::write(log, kStatusChannel, status);
  for (int first = 0; first < 2000; first += 20) {
    auto batch = test::batch_of(1, first, 20);
    for (auto& tick : batch.ticks) {
      tick.wakeup_latency_ns = static_cast<std::int32_t>(tick.tick);
      tick.f_device_N[0][2] = tick.tick == 777 ? 3.0 : 1.0;
      if (tick.tick >= 1000) tick.grasped_node[0] = 5;
      if (tick.tick == 1900) tick.flags = ligature_msg::tick_t::FLAG_PERIOD_LOST;
    }
    if (first != 400) test::write(log, kTicksChannel, batch);
    test::write(log, kThreadChannel,
                test::thread_of(first, first < 1500 ? test::straight_points(50) : test::overhand_points(60)));
  }
  log.close();
  return path;
}

TEST(LogSummary, CountsRateLossesForcesAndKnot) {
  const test::TestFolder folder;
  const auto summary = summarise(write_run(folder));
  EXPECT_DOUBLE_EQ(summary.duration_s(), 2.0);
  EXPECT_EQ(summary.tally.received(), 1980);
  EXPECT_EQ(summary.tally.missing(), 20);
  EXPECT_EQ(summary.ticks.executed(), 1979);
  EXPECT_EQ(summary.ticks.wakeup().max_ns, 1999);
  EXPECT_DOUBLE_EQ(summary.ticks.hands()[0].peak_N, 3.0);
  EXPECT_DOUBLE_EQ(summary.ticks.hands()[0].mean_N(), 1.0);
  ASSERT_EQ(summary.knots.size(), 2U);
  EXPECT_EQ(summary.knots[0].type, "0_1");
  EXPECT_EQ(summary.knots[1].type, "3_1");
  EXPECT_NEAR(summary.knot_first_s(), 1.5, 0.1);
}

TEST(LogSummary, TableAndJsonSayTheSame) {
  const test::TestFolder folder;
  const auto summary = summarise(write_run(folder));
  const auto json = nlohmann::json::parse(report_json(summary));
  EXPECT_EQ(json["ticks_lost"], 20);
  EXPECT_EQ(json["recorded_per_s"], 990.0);
  // Of 1980 recorded periods the loop lost one; missing records say nothing about the loop.
  EXPECT_DOUBLE_EQ(json["executed_percent"].get<double>(), 100.0 * 1979 / 1980);
  EXPECT_DOUBLE_EQ(json["executed_per_s"].get<double>(), 1000.0 * 1979 / 1980);
  EXPECT_EQ(json["periods_lost"], 1);
  // Percentiles of the values 0 .. 1999 without 400 .. 419 and 1900.
  EXPECT_DOUBLE_EQ(json["wakeup_us"]["p50"].get<double>(), 1.009);
  EXPECT_DOUBLE_EQ(json["wakeup_us"]["p99"].get<double>(), 1.98);
  EXPECT_EQ(json["knot"]["type"], "3_1");
  EXPECT_EQ(json["knot"]["common_name"], "overhand");
  EXPECT_EQ(json["hand_force"]["left"]["peak_N"], 3.0);
  EXPECT_EQ(json["wakeup_us"]["max"], 1.999);
  const auto table = report_table(summary);
  EXPECT_NE(table.find("1980 recorded, 20 lost"), std::string::npos) << table;
  EXPECT_NE(table.find("999.5 ticks per second, 99.949 % of periods executed"), std::string::npos) << table;
  EXPECT_NE(table.find("overhand; first tied"), std::string::npos) << table;
  EXPECT_NE(table.find("peak 3.000 N at 0.777 s"), std::string::npos) << table;
}

/// Reports a log whose shapes are knotted in the first, second or third of its seconds, as `knotted` says.
std::string report_of_seconds(const test::TestFolder& folder, std::array<bool, 3> knotted) {
  LogWriter log(folder.file("seconds.lcmlog"), true);
  for (int first = 5000; first < 8000; first += 20) {
    test::write(log, kTicksChannel, test::batch_of(1, first, 20));
    const bool is_knotted = knotted[static_cast<std::size_t>(first / 1000 - 5)];
    test::write(log, kThreadChannel,
                test::thread_of(first, is_knotted ? test::overhand_points(60) : test::straight_points(50)));
  }
  log.close();
  return report_table(summarise(folder.file("seconds.lcmlog")));
}

TEST(LogSummary, SaysTiedOrUntiedOnlyOfWhatTheRecordingShows) {
  const test::TestFolder folder;
  const auto says = [&](std::array<bool, 3> knotted, const char* words) {
    const auto table = report_of_seconds(folder, knotted);
    EXPECT_NE(table.find(words), std::string::npos) << table;
  };
  says({false, false, true}, "overhand; first tied at 7.00 s\n");
  says({false, true, false}, "0_1 (no knot); untied at 7.00 s, before that 3_1 ");
  says({true, true, true}, "overhand; there in the first recorded shape, at 5.00 s\n");
  says({true, false, true}, "overhand; there in the first recorded shape, at 5.00 s, unchanged since 7.00 s\n");
  says({false, false, false}, "0_1 (no knot)\n");
}

/// The report may claim "zero lost" only if the drives are off in the last recorded tick: otherwise the run may have
/// gone on.
TEST(LogSummary, SaysZeroLostOnlyOfRunsThatAreThereToTheirEnd) {
  const test::TestFolder folder;
  for (std::int8_t state = 0; state < 7; ++state) {
    for (const bool restarted : {false, true}) {
      const std::string path = folder.file(std::to_string(state) + (restarted ? "r.lcmlog" : ".lcmlog"));
      LogWriter log(path, false);
      auto last = test::batch_of(1, 10, 10);
      last.ticks.back().state = state;
      test::write(log, kTicksChannel, last);
      test::write(log, kTicksChannel, test::batch_of(1, 0, 10));  // filled from the flight recorder, so out of order
      if (restarted) test::write(log, kTicksChannel, test::batch_of(2, 0, 20));
      log.close();
      const auto summary = summarise(path);
      const bool ended = state == ligature_msg::tick_t::STATE_OFF;
      const auto table = report_table(summary);
      EXPECT_EQ(table.find("0 lost") != std::string::npos, ended) << table;
      EXPECT_EQ(table.find("open end") == std::string::npos, ended) << table;
      EXPECT_EQ(nlohmann::json::parse(report_json(summary))["ended"], ended);
      if (!ended) {
        EXPECT_NE(table.find("ends at tick 19 in " + std::string(state_name(state))), std::string::npos) << table;
      }
    }
  }
}

TEST(LogSummary, TellsHowTheThreadKeptUp) {
  const test::TestFolder folder;
  LogWriter log(folder.file("thread.lcmlog"), false);
  auto batch = test::batch_of(1, 0, 100);
  using ligature_msg::tick_t;
  for (std::size_t i = 0; i < 10; ++i) batch.ticks[i].thread_end = tick_t::THREAD_WORK, batch.ticks[i].time_lost = 0.5F;
  for (std::size_t i = 20; i < 24; ++i) batch.ticks[i].thread_end = tick_t::THREAD_CLOCK;
  for (std::size_t i = 30; i < 33; ++i)
    batch.ticks[i].flags = tick_t::FLAG_THREAD_LATE, batch.ticks[i].time_lost = 1.0F;
  batch.ticks[40].flags = tick_t::FLAG_PERIOD_LOST, batch.ticks[40].time_lost = 1.0F;
  test::write(log, kTicksChannel, batch);
  log.close();
  const auto summary = summarise(folder.file("thread.lcmlog"));
  const auto table = report_table(summary);
  EXPECT_NE(table.find("stood still for 0.005 s (5.05 % of the time); ticks ended by work 10, by the clock 4, late 3"),
            std::string::npos)
      << table;
  const auto json = nlohmann::json::parse(report_json(summary))["thread"];
  EXPECT_DOUBLE_EQ(json["stood_still_s"].get<double>(), 0.005);
  EXPECT_EQ(json["late"], 3);
}

/// One joint message comes 60 us after the wake-up, all others after 420 us.
TEST(LogSummary, LeavesOutSamplesThatTheBusCannotHaveCarried) {
  const auto least_ns = [](const std::string& header) {
    const test::TestFolder folder;
    LogWriter log(folder.file("early.lcmlog"), false);
    ligature_msg::status_t status{};
    status.period_s = 1e-3;
    status.scene_toml = header;
    test::write(log, kStatusChannel, status);
    auto batch = test::batch_of(1, 0, 100);
    for (auto& tick : batch.ticks) tick.tpdo_ns = 420'000;
    batch.ticks[50].tpdo_ns = 60'000;
    test::write(log, kTicksChannel, batch);
    log.close();
    return summarise(folder.file("early.lcmlog")).ticks.thread_time().at_least_ns(100);
  };
  EXPECT_EQ(least_ns("\n# as run:\n# samples 380000") - least_ns(""), 360'000);
}

TEST(LogSummary, RefusesALogWithoutTicks) {
  const test::TestFolder folder;
  LogWriter log(folder.file("a.lcmlog"), false);
  test::write(log, kThreadChannel, test::thread_of(0, test::straight_points(5)));
  log.close();
  EXPECT_THROW(static_cast<void>(summarise(folder.file("a.lcmlog"))), BadInput);
}

}  // namespace
}  // namespace ligature::host
