#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "host/csv_row.hpp"
#include "host/errors.hpp"
#include "host/export.hpp"
#include "host/log_format.hpp"
#include "host/rig_facts.hpp"
#include "synthetic_log.hpp"

namespace ligature::host {
namespace {

std::ptrdiff_t fields_in(const std::string& line) { return std::ranges::count(line, ',') + 1; }

class Export : public ::testing::Test {
 protected:
  std::string write_log() {
    LogWriter log(folder_.file("a.lcmlog"), true);
    ligature_msg::status_t status{};
    status.period_s = 2e-3;
    auto batch = test::batch_of(1, 0, 20);
    batch.ticks[3].f_device_N[0][0] = 0.1 + 0.2;
    batch.ticks[3].f_device_N[0][1] = -4.0;
    batch.ticks[3].grasped_node[0] = 17;
    test::write(log, kTicksChannel, batch);
    test::write(log, kStatusChannel, status);
    test::write(log, kTicksChannel, batch);                             // the same batch twice
    log.write(0, kTicksChannel, test::encoded(ligature_msg::ack_t{}));  // not a tick batch
    test::write(log, kThreadChannel, test::thread_of(10, test::straight_points(5)));
    test::write(log, kTicksChannel, test::batch_of(2, 0, 5));  // the firmware was restarted
    log.close();
    return folder_.file("a.lcmlog");
  }
  ExportTargets targets() const {
    return {.csv = {folder_.file("f.csv"), folder_.file("s.csv"), folder_.file("t.csv")}};
  }

  test::TestFolder folder_;
};

TEST_F(Export, WritesEveryTickOfEverySessionOnce) {
  const auto result = export_recording(write_log(), targets());
  EXPECT_EQ(result.tick_rows, 25);
  EXPECT_EQ(result.duplicates_left_out, 20);
  EXPECT_EQ(result.unreadable_messages, 1);
  EXPECT_EQ(result.damage, "");
  for (const char* name : {"f.csv", "t.csv"}) {
    const auto lines = test::lines_of(folder_.file(name));
    ASSERT_EQ(lines.size(), 26U);
    for (const auto& line : lines) EXPECT_EQ(fields_in(line), fields_in(lines[0])) << name;
    EXPECT_TRUE(lines[0].starts_with("tick,t_s,"));
    EXPECT_TRUE(lines[0].ends_with(",session"));
    EXPECT_TRUE(lines[4].starts_with("3,0.006,"));  // time by the period in the status message
    EXPECT_TRUE(lines[25].ends_with(",2"));
  }
}

TEST_F(Export, ForcesStandInTheColumnsOfTheirNames) {
  export_recording(write_log(), targets());
  const auto lines = test::lines_of(folder_.file("f.csv"));
  EXPECT_TRUE(lines[0].starts_with(
      "tick,t_s,left_device_f_x_N,left_device_f_y_N,left_device_f_z_N,left_device_f_N,"
      "left_world_f_x_N,left_world_f_y_N,left_world_f_z_N,left_world_f_N,left_grip,left_node,right_device_f_x_N"));
  EXPECT_TRUE(lines[4].starts_with("3,0.006,0.30000000000000004,-4,0,4.01123422402")) << lines[4];
  EXPECT_NE(lines[4].find(",0,17,"), std::string::npos);
}

TEST_F(Export, ShapeIsTheDesignsTable) {
  export_recording(write_log(), targets());
  const auto lines = test::lines_of(folder_.file("s.csv"));
  ASSERT_EQ(lines.size(), 6U);
  EXPECT_EQ(lines[0], "t_s,node,x_m,y_m,z_m");
  EXPECT_EQ(lines[1], "0.02,0,0,0,5.5");
}

TEST_F(Export, ACutLogIsExportedUpToItsLastWholeEvent) {
  const std::string whole = test::text_of(write_log());
  test::write_text(folder_.file("cut.lcmlog"), whole.substr(0, whole.size() - kCheckEventBytes - 1));
  const auto result = export_recording(folder_.file("cut.lcmlog"), targets());
  EXPECT_EQ(result.tick_rows, 20);
  EXPECT_NE(result.damage, "");
}

TEST_F(Export, LeavesNothingWhenItRefuses) {
  test::write_text(folder_.file("no.lcmlog"), "not a log");
  EXPECT_THROW(export_recording(folder_.file("no.lcmlog"), targets()), BadInput);
  {
    LogWriter log(folder_.file("tickless.lcmlog"), false);
    test::write(log, kThreadChannel, test::thread_of(0, test::straight_points(5)));
    log.close();
  }
  EXPECT_THROW(export_recording(folder_.file("tickless.lcmlog"), targets()), BadInput);
  auto unwritable = targets();
  unwritable.csv.ticks = folder_.file("no/where.csv");
  EXPECT_THROW(export_recording(write_log(), unwritable), BadInput);
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
    EXPECT_EQ(entry.path().extension(), ".lcmlog") << entry.path();
}

TEST_F(Export, TicksThatCameLateStandInTheirPlace) {
  LogWriter log(folder_.file("a.lcmlog"), true);
  for (const int first : {0, 40, 60, 20, 100}) test::write(log, kTicksChannel, test::batch_of(1, first, 20));
  log.close();
  const auto result = export_recording(folder_.file("a.lcmlog"), targets());
  EXPECT_EQ(result.tick_rows, 100);
  EXPECT_EQ(result.missing_ticks, "80..99");
  const auto lines = test::lines_of(folder_.file("t.csv"));
  ASSERT_EQ(lines.size(), 101U);
  for (std::size_t i = 1; i < lines.size(); ++i)
    EXPECT_TRUE(lines[i].starts_with(std::to_string(i <= 80 ? i - 1 : i + 19) + ",")) << lines[i];
}

TEST(CsvRow, NumbersReadBackToTheSameBits) {
  CsvRow row;
  for (const double value : {0.1, 1e-300, -3.3, 123456789.123456789, 5e-324}) {
    const std::string line = row.add(value).finish();
    EXPECT_EQ(std::strtod(line.c_str(), nullptr), value);
  }
  EXPECT_EQ(row.add(1).add("a").add(std::int16_t{-2}).finish(), "1,a,-2\n");
}

TEST(RigFacts, ATimeIsItsDecimalNumber) {
  const RigFacts facts;
  EXPECT_EQ(facts.time_s(700), 0.7);
  for (std::int64_t tick = 0; tick < 100'000; tick += 7)
    EXPECT_EQ(facts.time_s(tick), static_cast<double>(tick) / 1000);
  RigFacts odd;
  odd.period_s = 0.0015;
  EXPECT_DOUBLE_EQ(odd.time_s(2), 0.003);
}

}  // namespace
}  // namespace ligature::host
