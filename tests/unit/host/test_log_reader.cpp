// Truth: files written by LCM's own event log writer, then damaged.
#include <gtest/gtest.h>

#include "host/errors.hpp"
#include "host/log_reader.hpp"
#include "synthetic_log.hpp"

namespace ligature::host {
namespace {

constexpr int kEvents = 10;

std::string write_log(const test::TestFolder& folder) {
  const std::string path = folder.file("a.lcmlog");
  LogWriter log(path, false);
  for (int i = 0; i < kEvents; ++i) test::write(log, kTicksChannel, test::batch_of(1, i * 20, 20));
  log.close();
  return path;
}

/// Reads all; the first ticks of the batches that came.
std::vector<std::int64_t> first_ticks(LogReader& log) {
  std::vector<std::int64_t> ticks;
  while (const LogEvent* event = log.next())
    ticks.push_back(decode<ligature_msg::tick_batch_t>(event->data)->ticks[0].tick);
  return ticks;
}

TEST(LogReader, ReadsWhatTheLibraryWrote) {
  const test::TestFolder folder;
  LogReader log(write_log(folder));
  const LogEvent* event = log.next();
  ASSERT_TRUE(event);
  EXPECT_EQ(event->channel, kTicksChannel);
  EXPECT_EQ(event->timestamp_us, 1);
  EXPECT_EQ(first_ticks(log).size(), kEvents - 1U);
  EXPECT_EQ(log.damage(), "");
  EXPECT_EQ(log.next(), nullptr);
}

TEST(LogReader, ATruncatedLogEndsWithItsLastWholeEvent) {
  const test::TestFolder folder;
  const std::string whole = test::text_of(write_log(folder));
  const std::size_t event_size = whole.size() / kEvents;
  for (const std::size_t cut : {std::size_t{1}, std::size_t{27}, std::size_t{29}, event_size - 1}) {
    const std::string path = folder.file("cut.lcmlog");
    test::write_text(path, whole.substr(0, 7 * event_size + cut));
    LogReader log(path);
    EXPECT_EQ(first_ticks(log).size(), 7U);
    EXPECT_TRUE(log.is_truncated());
    EXPECT_EQ(log.tail_bytes(), static_cast<std::int64_t>(cut));
    EXPECT_NE(log.damage().find("last whole one"), std::string::npos);
  }
}

TEST(LogReader, GoesOnBehindABrokenEvent) {
  const test::TestFolder folder;
  std::string bytes = test::text_of(write_log(folder));
  const std::size_t event_size = bytes.size() / kEvents;
  bytes[3 * event_size] = 'x';                                   // a sync word
  bytes.replace(6 * event_size + 24, 4, "\x7F\xFF\xFF\xFF", 4);  // a data length
  test::write_text(folder.file("broken.lcmlog"), bytes);
  LogReader log(folder.file("broken.lcmlog"));
  EXPECT_EQ(first_ticks(log), (std::vector<std::int64_t>{0, 20, 40, 80, 100, 140, 160, 180}));
  EXPECT_EQ(log.skipped_bytes(), static_cast<std::int64_t>(2 * event_size));
  EXPECT_FALSE(log.is_truncated());
}

TEST(LogReader, RefusesWhatIsNoLog) {
  const test::TestFolder folder;
  EXPECT_THROW(LogReader(folder.file("missing")), BadInput);
  EXPECT_THROW(LogReader(folder.path().string()), BadInput);
  for (const char* text : {"", "\xED\xA1", "x,y,z\n1,2,3\n"}) {
    test::write_text(folder.file("other"), text);
    EXPECT_THROW(LogReader(folder.file("other")), BadInput);
  }
}

}  // namespace
}  // namespace ligature::host
