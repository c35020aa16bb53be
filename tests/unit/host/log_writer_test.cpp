#include <gtest/gtest.h>
#include <sys/resource.h>

#include <filesystem>

#include "host/console/stop_signal.hpp"
#include "host/errors.hpp"
#include "host/log_reader.hpp"
#include "synthetic_log.hpp"

namespace ligature::host {
namespace {

TEST(LogWriter, ReplacesAFileOnlyWhenTold) {
  const test::TestFolder folder;
  const std::string path = folder.file("a.lcmlog");
  test::write_text(path, "precious");
  EXPECT_THROW(LogWriter(path, false), BadInput);
  EXPECT_EQ(test::text_of(path), "precious");
  LogWriter(path, true).close();
  EXPECT_EQ(test::text_of(path), "precious") << "nothing was written";
  LogWriter log(path, true);
  EXPECT_EQ(test::text_of(path), "precious");
  test::write(log, kTicksChannel, test::batch_of(1, 0, 20));
  EXPECT_NE(LogReader(path).next(), nullptr);
  EXPECT_EQ(static_cast<std::int64_t>(std::filesystem::file_size(path)), log.bytes());
}

TEST(LogWriter, TouchesNoFileThatWasMovedAwayBeforeTheFirstWrite) {
  const test::TestFolder folder;
  const std::string path = folder.file("a.lcmlog"), kept = folder.file("kept.lcmlog");
  test::write_text(path, "precious");
  LogWriter log(path, true);
  std::filesystem::rename(path, kept);
  test::write(log, kTicksChannel, test::batch_of(1, 0, 20));
  EXPECT_EQ(test::text_of(kept), "precious");
  EXPECT_NE(LogReader(path).next(), nullptr);
}

TEST(LogWriter, RefusesToReplaceAFileThatCameInBetween) {
  const test::TestFolder folder;
  const std::string path = folder.file("a.lcmlog"), other = folder.file("other.lcmlog");
  test::write_text(path, "precious");
  LogWriter log(path, true);
  test::write_text(other, "another's");
  std::filesystem::rename(other, path);
  EXPECT_THROW(test::write(log, kTicksChannel, test::batch_of(1, 0, 20)), BadInput);
  EXPECT_EQ(test::text_of(path), "another's");
}

TEST(LogWriter, RefusesAFolderThatIsNotThere) {
  const test::TestFolder folder;
  EXPECT_THROW(LogWriter(folder.file("no/where.lcmlog"), false), BadInput);
}

TEST(LogWriter, WhatWasWrittenIsInTheFileAtOnce) {
  const test::TestFolder folder;
  LogWriter log(folder.file("a.lcmlog"), false);
  test::write(log, kTicksChannel, test::batch_of(1, 0, 20));
  EXPECT_EQ(static_cast<std::int64_t>(std::filesystem::file_size(folder.file("a.lcmlog"))), log.bytes());
}

TEST(LogWriter, AFullDiskIsAnError) {
  if (!std::filesystem::exists("/dev/full")) FAIL() << "no /dev/full on this system";
  LogWriter log("/dev/full", true);
  EXPECT_THROW(test::write(log, kTicksChannel, test::batch_of(1, 0, 20)), RunFailed);
}

TEST(LogWriter, AFileSizeLimitIsAnErrorAndKeepsWhatCameBefore) {
  const test::TestFolder folder;
  const std::string path = folder.file("a.lcmlog");
  LogWriter log(path, false);
  console::catch_stop_signals();  // also ignores SIGXFSZ
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{.rlim_cur = 100'000, .rlim_max = before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  int written = 0;
  EXPECT_THROW(for (; written < 1000; ++written) test::write(log, kTicksChannel, test::batch_of(1, written * 20, 20)),
               RunFailed);
  setrlimit(RLIMIT_FSIZE, &before);
  LogReader kept(path);
  int events = 0;
  while (kept.next()) ++events;
  EXPECT_GT(events, 5);
  EXPECT_EQ(events, written);  // everything reported as written can be read
}

}  // namespace
}  // namespace ligature::host
