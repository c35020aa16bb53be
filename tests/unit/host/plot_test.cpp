#include <gtest/gtest.h>
#include <stdlib.h>

#include "host/errors.hpp"
#include "host/plot.hpp"
#include "synthetic_log.hpp"

namespace ligature::host {
namespace {

std::string write_log(const test::TestFolder& folder) {
  LogWriter log(folder.file("a.lcmlog"), false);
  for (int first = 0; first < 30'000; first += 500) {
    if (first == 9000) continue;  // a gap
    auto batch = test::batch_of(1, first, 500);
    for (auto& tick : batch.ticks) {
      tick.state = tick.tick < 3000 ? 2 : 4;
      tick.grasped_node[0] = tick.tick > 5000 && tick.tick < 25'000 ? 12 : -1;
      tick.f_device_N[0][0] = tick.grasped_node[0] >= 0 ? 1.5 : 0.0;
    }
    test::write(log, kTicksChannel, batch);
  }
  log.close();
  return folder.file("a.lcmlog");
}

TEST(Plot, DrawsAWholePicture) {
  const test::TestFolder folder;
  plot(write_log(folder), folder.file("forces.png"), false);
  const std::string png = test::text_of(folder.file("forces.png"));
  EXPECT_TRUE(png.starts_with("\x89PNG"));
  EXPECT_NE(png.find("IEND"), std::string::npos);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 2);  // only the log and the picture
}

TEST(Plot, SaysHowToGetAMissingPython) {
  const test::TestFolder folder;
  const std::string log = write_log(folder);
  setenv("LIGATURE_PYTHON", "/no/python", 1);
  try {
    plot(log, folder.file("forces.png"), false);
    ADD_FAILURE();
  } catch (const BadInput& error) {
    EXPECT_NE(std::string(error.what()).find("scripts/setup"), std::string::npos);
  }
  unsetenv("LIGATURE_PYTHON");
  EXPECT_FALSE(std::filesystem::exists(folder.file("forces.png")));
}

TEST(Plot, AlignsByGraspOnlyLogsThatHaveOne) {
  const test::TestFolder folder;
  const std::string log = write_log(folder), idle = folder.file("idle.lcmlog");
  LogWriter writer(idle, false);
  test::write(writer, kTicksChannel, test::batch_of(1, 0, 500));
  writer.close();
  for (const auto& [a, b] : {std::pair{log, idle}, std::pair{idle, log}}) {
    try {
      plot_comparison(a, b, folder.file("both.png"), "grasp", 0.0);
      ADD_FAILURE();
    } catch (const BadInput& error) {
      EXPECT_EQ(error.what(), idle + ": --align grasp: the log has no grasp; align by start");
    }
  }
  EXPECT_FALSE(std::filesystem::exists(folder.file("both.png")));
  plot_comparison(log, log, folder.file("both.png"), "grasp", 0.0);
  EXPECT_TRUE(std::filesystem::exists(folder.file("both.png")));
}

TEST(Plot, RefusesPicturesItCannotDraw) {
  const test::TestFolder folder;
  const std::string log = write_log(folder);
  EXPECT_THROW(plot(log, folder.file("forces.xyz"), false), BadInput);
  EXPECT_THROW(plot(log, folder.file("no/forces.png"), false), BadInput);
}

}  // namespace
}  // namespace ligature::host
