#include "host/view/log_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <limits>

#include "host/errors.hpp"
#include "host/log_reader.hpp"
#include "tests/unit/host/synthetic_log.hpp"

namespace ligature::host::view {
namespace {

constexpr int kBatches = 200;

/// Batches of 20 ticks every 20 ms, with an unrelated message after each.
std::string make_log(const test::TestFolder& folder) {
  const std::string path = folder.file("run.lcmlog");
  LogWriter log(path, false);
  for (int i = 0; i < kBatches; ++i) {
    auto batch = test::batch_of(1, 20 * i, 20);
    batch.utime = 1'000'000 + 20'000LL * i;
    test::write(log, kTicksChannel, batch);
    log.write(batch.utime, "SOMETHING_ELSE", test::encoded(test::tick_of(0)));
  }
  log.close();
  return path;
}

TEST(LogMap, FindsEveryMessageThatTheReaderFinds) {
  const test::TestFolder folder;
  const LogMap map(make_log(folder));
  ASSERT_EQ(map.entries().size(), static_cast<std::size_t>(kBatches));
  EXPECT_NEAR(map.duration_s(), 0.02 * (kBatches - 1), 1e-9);
  LogReader reader(folder.file("run.lcmlog"));
  std::vector<std::byte> payload;
  std::size_t i = 0;
  while (const auto* event = reader.next()) {
    if (event->channel != kTicksChannel) continue;
    ASSERT_TRUE(map.read(map.entries()[i++], payload));
    EXPECT_TRUE(std::ranges::equal(payload, event->data));
  }
  EXPECT_EQ(i, map.entries().size());
}

TEST(LogMap, FindsAMoment) {
  const test::TestFolder folder;
  const LogMap map(make_log(folder));
  EXPECT_EQ(map.after(-1.0), 0U);
  EXPECT_EQ(map.after(1.0), 51U);  // entries at 0, 0.02, .. 1.0 come before
  EXPECT_EQ(map.after(1e9), map.entries().size());
}

TEST(LogMap, PlaysOnWhenTheClockOnTheWallWasSetMeanwhile) {
  constexpr std::int64_t kSecond = 1'000'000;
  const std::int64_t largest = std::numeric_limits<std::int64_t>::max();
  for (const std::int64_t step_us : {-60 * kSecond, 3600 * kSecond, -50 * 365 * 86'400 * kSecond, largest, -largest}) {
    const test::TestFolder folder;
    const std::string path = folder.file("run.lcmlog");
    LogWriter log(path, false);
    for (int i = 0; i < kBatches; ++i) {
      const std::int64_t passed_us = 20'000LL * i, begin_us = 1'800'000'000 * kSecond;
      const bool is_set = i >= kBatches / 2 && i < kBatches - 10;  // and set back near the end
      const bool is_extreme = step_us == largest || step_us == -largest;
      const auto stamp_us = !is_set ? begin_us + passed_us : is_extreme ? step_us : begin_us + step_us + passed_us;
      log.write(stamp_us, kTicksChannel, test::encoded(test::batch_of(1, 20 * i, 20)));
    }
    log.close();
    const LogMap map(path);
    EXPECT_LE(map.duration_s(), 0.02 * kBatches + 1e-6) << step_us;
    EXPECT_TRUE(std::ranges::is_sorted(map.entries(), {}, &LogMap::Entry::offset)) << step_us << ": in the order heard";
  }
}

TEST(LogMap, GoesOnBehindABrokenStretchAndStopsAtACutEnd) {
  const test::TestFolder folder;
  const std::string path = make_log(folder);
  const auto size = std::filesystem::file_size(path);
  {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(size / 2));
    const std::string noise(300, 'x');
    file.write(noise.data(), static_cast<std::streamsize>(noise.size()));
  }
  std::filesystem::resize_file(path, size - 5);
  const LogMap map(path);
  EXPECT_LT(map.entries().size(), static_cast<std::size_t>(kBatches));
  EXPECT_GE(map.entries().size(), static_cast<std::size_t>(kBatches - 3));
}

TEST(LogMap, RefusesWhatIsNoRecording) {
  const test::TestFolder folder;
  test::write_text(folder.file("text"), "not a log");
  test::write_text(folder.file("empty"), "");
  EXPECT_THROW(LogMap(folder.file("text")), BadInput);
  EXPECT_THROW(LogMap(folder.file("empty")), BadInput);
  EXPECT_THROW(LogMap(folder.file("missing")), BadInput);
  EXPECT_THROW(LogMap(folder.path().string()), BadInput);
}

}  // namespace
}  // namespace ligature::host::view
