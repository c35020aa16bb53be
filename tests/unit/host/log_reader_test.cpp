// LogReader reads LCM logs: files written by LCM's own event log writer, and damaged ones.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <cstdlib>

#include "host/console/stop_signal.hpp"
#include "host/errors.hpp"
#include "host/log_reader.hpp"
#include "host/sync_search.hpp"
#include "synthetic_log.hpp"
#include "tests/support/random.hpp"

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

/// Reads the whole log. @return the first tick of each batch.
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
  for (const std::size_t cut : {std::size_t{1}, std::size_t{27}, std::size_t{29}, event_size - kCheckEventBytes - 1}) {
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
  bytes[3 * event_size] = 'x';                                   // the sync word of event 3
  bytes.replace(6 * event_size + 24, 4, "\x7F\xFF\xFF\xFF", 4);  // the data length of event 6
  test::write_text(folder.file("broken.lcmlog"), bytes);
  LogReader log(folder.file("broken.lcmlog"));
  EXPECT_EQ(first_ticks(log), (std::vector<std::int64_t>{0, 20, 40, 80, 100, 140, 160, 180}));
  EXPECT_EQ(log.skipped_bytes(), static_cast<std::int64_t>(2 * event_size));
  EXPECT_FALSE(log.is_truncated());
}

TEST(LogReader, AnEventWithoutTheWholeOfItsChecksumIsTheLastOneOfAKilledRecorder) {
  const test::TestFolder folder;
  const std::string whole = test::text_of(write_log(folder));
  const std::size_t event_size = whole.size() / kEvents;
  for (const std::size_t lacking : {std::size_t{1}, kCheckEventBytes - 2, kCheckEventBytes}) {
    test::write_text(folder.file("cut.lcmlog"), whole.substr(0, 8 * event_size - lacking));
    LogReader log(folder.file("cut.lcmlog"));
    EXPECT_EQ(first_ticks(log).size(), 8U);
    EXPECT_EQ(log.tail_bytes(), static_cast<std::int64_t>(kCheckEventBytes - lacking));
  }
}

TEST(LogReader, NoFlippedBitGoesUnnoticed) {
  const test::TestFolder folder;
  const std::string whole = test::text_of(write_log(folder));
  const auto truth = [&] {
    LogReader log(folder.file("a.lcmlog"));
    std::vector<std::string> events;
    while (const LogEvent* event = log.next())
      events.emplace_back(reinterpret_cast<const char*>(event->data.data()), event->data.size());
    return events;
  }();
  ligature::test::Random random(98);
  const std::size_t first = 28 + kTicksChannel.size() + 8;  // after the part that identifies the file as a log
  for (int i = 0; i < 200; ++i) {
    std::string broken = whole;
    const std::size_t at = first + random() % (whole.size() - first);
    broken[at] = static_cast<char>(broken[at] ^ (1 << random() % 8));
    test::write_text(folder.file("broken.lcmlog"), broken);
    LogReader log(folder.file("broken.lcmlog"));
    std::size_t came = 0;
    while (const LogEvent* event = log.next()) {
      const std::string data(reinterpret_cast<const char*>(event->data.data()), event->data.size());
      ASSERT_NE(std::ranges::find(truth, data), truth.end()) << "byte " << at << ": what nobody wrote was handed out";
      ++came;
    }
    EXPECT_GE(came, truth.size() - 1) << "byte " << at << ": one flipped bit costs one event at most";
    const std::size_t in_event = at % (whole.size() / kEvents);
    const bool is_number =
        (in_event >= 4 && in_event < 12) ||  // the event's number, which is not needed
        (in_event >= whole.size() / kEvents - kCheckEventBytes + 4 &&
         in_event < whole.size() / kEvents - kCheckEventBytes + 20);  // and number and time of its checksum event
    if (!is_number) {
      EXPECT_NE(log.damage(), "") << "byte " << at;
    }
  }
}

TEST(LogReader, ALogOfAnotherRecorderHasNoChecksumsAndIsSound) {
  const test::TestFolder folder;
  const std::string whole = test::text_of(write_log(folder));
  const std::size_t event_size = whole.size() / kEvents;
  std::string plain;
  for (std::size_t i = 0; i < kEvents; ++i) plain += whole.substr(i * event_size, event_size - kCheckEventBytes);
  test::write_text(folder.file("plain.lcmlog"), plain);
  LogReader log(folder.file("plain.lcmlog"));
  EXPECT_EQ(first_ticks(log).size(), static_cast<std::size_t>(kEvents));
  EXPECT_EQ(log.damage(), "");
  // A log that was played back by lcm-logplayer and recorded by lcm-logger: the same checksums, other times.
  std::string played = whole;
  for (std::size_t i = 0; i < kEvents; ++i)
    for (const std::size_t head : {std::size_t{0}, event_size - kCheckEventBytes})
      played[i * event_size + head + 15] = 'x';
  test::write_text(folder.file("played.lcmlog"), played);
  LogReader again(folder.file("played.lcmlog"));
  EXPECT_EQ(first_ticks(again).size(), static_cast<std::size_t>(kEvents));
  EXPECT_EQ(again.damage(), "");
}

TEST(LogReader, AHoleOf60GBCostsNothing) {
  const test::TestFolder folder;
  const std::string path = write_log(folder);
  const auto size = std::filesystem::file_size(path);
  std::filesystem::resize_file(path, 60'000'000'000);
  LogReader log(path);
  EXPECT_EQ(first_ticks(log).size(), static_cast<std::size_t>(kEvents));
  EXPECT_EQ(log.tail_bytes(), 60'000'000'000 - static_cast<std::int64_t>(size));
}

TEST(LogReader, ASignalEndsItWhereverItIs) {
  const test::TestFolder folder;
  const std::string path = write_log(folder);
  const auto end_by_signal = [&](bool in_garbage) {
    console::catch_stop_signals();
    LogReader log(path);
    if (in_garbage) (void)log.next();
    raise(SIGTERM);
    try {
      if (in_garbage) (void)find_sync(RegularFile(path), 1, nullptr);
      (void)log.next();
    } catch (const RunFailed&) {
      std::_Exit(7);
    }
    std::_Exit(0);
  };
  EXPECT_EXIT(end_by_signal(false), ::testing::ExitedWithCode(7), "");
  EXPECT_EXIT(end_by_signal(true), ::testing::ExitedWithCode(7), "");
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
