// The view of a stored recording (tests/fixtures/make_golden.py) always has the same knot names, events and numbers.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "host/export.hpp"
#include "host/log_reader.hpp"
#include "host/view/log_survey.hpp"
#include "ligature_source_dir.hpp"
#include "tests/unit/host/synthetic_log.hpp"

namespace ligature::host::view {
namespace {

using nlohmann::json;
const std::string kFixtures = LIGATURE_SOURCE_DIR "/tests/fixtures/";

json golden() { return json::parse(std::ifstream(kFixtures + "golden.json")); }

TEST(Golden, ReplaysToTheSameLabelsAndEvents) {
  const LogMap map(kFixtures + "golden.lcmlog");
  const LogSurvey survey(map);
  while (survey.progress() < 1.0) std::this_thread::yield();
  EXPECT_EQ(survey.marks()["marks"], golden()["marks"]) << survey.marks()["marks"].dump(1);
}

TEST(Golden, TheTracesAreTheExportedFiguresToTheLastBit) {
  const test::TestFolder folder;
  const std::string table = folder.file("forces.csv");
  (void)export_recording(kFixtures + "golden.lcmlog", {.csv = {.forces = table, .shape = {}, .ticks = {}}});
  const auto lines = test::lines_of(table);
  std::size_t line = 1;
  LogReader log(kFixtures + "golden.lcmlog");
  while (const LogEvent* event = log.next()) {
    if (event->channel != kTicksChannel) continue;
    const auto batch = decode<ligature_msg::tick_batch_t>(event->data);
    ASSERT_TRUE(batch);
    for (const auto& tick : batch->ticks) {
      const TraceRow row = trace_row(tick);
      std::vector<double> cells;
      std::istringstream text(lines.at(line++));
      for (std::string cell; std::getline(text, cell, ',');) cells.push_back(std::strtod(cell.c_str(), nullptr));
      ASSERT_EQ(row[kTick], cells[0]);
      for (std::size_t k = 0; k < 4; ++k) ASSERT_EQ(row[kLeftX + k], cells[2 + k]) << "tick " << tick.tick;
      for (std::size_t k = 0; k < 4; ++k) ASSERT_EQ(row[kRightX + k], cells[12 + k]) << "tick " << tick.tick;
      ASSERT_EQ(row[kLeftWorld], cells[9]) << "tick " << tick.tick;
      ASSERT_EQ(row[kRightWorld], cells[19]) << "tick " << tick.tick;
    }
  }
  EXPECT_EQ(line, 401U);
  const json expected = golden()["left_device_f_x_N_at_8700"];
  EXPECT_EQ(std::strtod(lines.at(101).substr(lines[101].find(',', lines[101].find(',') + 1) + 1).c_str(), nullptr),
            expected.get<double>());
}

}  // namespace
}  // namespace ligature::host::view
