#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "host/errors.hpp"
#include "host/log_summary.hpp"
#include "host/report.hpp"
#include "synthetic_log.hpp"

namespace ligature::host {
namespace {

/// Two seconds in batches of 20; the batch at 0.4 s never came, a shape every 20 ms, tied from 1.5 s on.
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
  // One of 1980 recorded periods was lost: what was not recorded says nothing about the loop.
  EXPECT_DOUBLE_EQ(json["executed_percent"].get<double>(), 100.0 * 1979 / 1980);
  EXPECT_DOUBLE_EQ(json["executed_per_s"].get<double>(), 1000.0 * 1979 / 1980);
  EXPECT_EQ(json["periods_lost"], 1);
  EXPECT_DOUBLE_EQ(json["wakeup_us"]["p50"].get<double>(), 1.009);  // of 0 .. 1999 without 400 .. 419 and 1900
  EXPECT_DOUBLE_EQ(json["wakeup_us"]["p99"].get<double>(), 1.98);
  EXPECT_EQ(json["knot"]["type"], "3_1");
  EXPECT_EQ(json["hand_force"]["left"]["peak_N"], 3.0);
  EXPECT_EQ(json["wakeup_us"]["max"], 1.999);
  const auto table = report_table(summary);
  EXPECT_NE(table.find("1980 recorded, 20 lost"), std::string::npos) << table;
  EXPECT_NE(table.find("999.5 ticks per second, 99.949 % of periods executed"), std::string::npos) << table;
  EXPECT_NE(table.find("3_1"), std::string::npos) << table;
  EXPECT_NE(table.find("peak 3.000 N at 0.777 s"), std::string::npos) << table;
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
