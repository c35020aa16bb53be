// The recorder against its reader: what was written is there, whoever dies, and what is damaged is said to be.
#include "firmware/telemetry/flight_recorder.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <fstream>
#include <random>

#include "host/errors.hpp"
#include "host/export.hpp"
#include "host/flight_reader.hpp"
#include "host/gap_filler.hpp"
#include "tests/unit/host/synthetic_log.hpp"

namespace ligature::telemetry {
namespace {

using host::FlightReader;
using host::test::tick_of;

const FlightFacts kFacts{77, 0.001, 2.5, "1.2.3", "a.toml", "[suture]"};

std::unique_ptr<FlightRecorder> open_or_die(const std::string& path, std::int64_t slots) {
  auto opened = FlightRecorder::open(path, kFacts, slots);
  EXPECT_TRUE(std::holds_alternative<std::unique_ptr<FlightRecorder>>(opened)) << std::get<std::string>(opened);
  return std::move(std::get<0>(opened));
}

std::vector<std::int64_t> ticks_in(const FlightReader& reader) {
  std::vector<std::int64_t> ticks;
  reader.visit([&](const auto& tick) { ticks.push_back(tick.tick); });
  return ticks;
}

class FlightRecorderTest : public ::testing::Test {
 protected:
  host::test::TestFolder folder;
  std::string path = folder.file("flight.rec");
};

TEST_F(FlightRecorderTest, TicksReadBackWhileTheWriterLives) {
  auto recorder = open_or_die(path, 100);
  auto tick = tick_of(5);
  tick.f_device_N[1][2] = -1.25;
  tick.law_ns = 4711;
  recorder->write(tick);
  recorder->write(tick_of(6));
  const FlightReader reader(path);
  EXPECT_EQ(reader.session(), 77);
  EXPECT_EQ(reader.facts().max_force_N, 2.5);
  EXPECT_EQ(reader.facts().scene_file, "a.toml");
  std::vector<ligature_msg::tick_t> read;
  reader.visit([&](const auto& t) { read.push_back(t); });
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[0].f_device_N[1][2], -1.25);
  EXPECT_EQ(read[0].law_ns, 4711);
  EXPECT_EQ(read[1].tick, 6);
}

TEST_F(FlightRecorderTest, KeepsTheNewestWhenTheRingIsFull) {
  auto recorder = open_or_die(path, 50);
  for (std::int64_t t = 0; t < 175; ++t) recorder->write(tick_of(t));
  const auto ticks = ticks_in(FlightReader(path));
  ASSERT_EQ(ticks.size(), 50U);
  for (std::size_t i = 0; i < 50; ++i) EXPECT_EQ(ticks[i], static_cast<std::int64_t>(125 + i));
}

TEST_F(FlightRecorderTest, OneProcessAtATimeAndTheRunBeforeIsKept) {
  {
    auto recorder = open_or_die(path, 10);
    recorder->write(tick_of(1));
    EXPECT_TRUE(std::holds_alternative<std::string>(FlightRecorder::open(path, kFacts, 10)));
  }
  auto next = open_or_die(path, 10);
  EXPECT_EQ(ticks_in(FlightReader(path + ".previous")), std::vector<std::int64_t>{1});
}

TEST_F(FlightRecorderTest, RefusesAFolderThatIsNotThereAndADiskThatIsFull) {
  EXPECT_TRUE(std::holds_alternative<std::string>(FlightRecorder::open(folder.file("no/flight.rec"), kFacts, 10)));
  const std::int64_t too_much = std::int64_t{1} << 52;
  EXPECT_TRUE(std::holds_alternative<std::string>(FlightRecorder::open(path, kFacts, too_much)));
  EXPECT_FALSE(std::filesystem::exists(path)) << "half a file was left";
}

TEST_F(FlightRecorderTest, SavesTheTicksBeforeAFaultAndEndsBeforeTheDiskIsFull) {
  auto recorder = open_or_die(path, 100);
  EXPECT_EQ(recorder->save_last(50, 11), "");  // nothing yet
  for (std::int64_t t = 0; t < 130; ++t) recorder->write(tick_of(t));
  const std::string saved = recorder->save_last(50, 11);
  ASSERT_NE(saved, "");
  const FlightReader reader(saved);
  EXPECT_EQ(reader.fault(), 11);
  EXPECT_EQ(reader.damaged_slots(), 0);
  const auto ticks = ticks_in(reader);
  ASSERT_EQ(ticks.size(), 50U);
  EXPECT_EQ(ticks.front(), 80);
  EXPECT_EQ(ticks.back(), 129);
  for (int i = 1; i < FlightRecorder::kMaxSaved; ++i) EXPECT_NE(recorder->save_last(5, 11), "");
  EXPECT_EQ(recorder->save_last(5, 11), "");
}

TEST_F(FlightRecorderTest, DamageIsFoundByTheCrc) {
  open_or_die(path, 10)->write(tick_of(1));
  std::string bytes = host::test::text_of(path);
  std::string broken = bytes;
  broken[recorder::kHeaderBytes + 100] ^= 1;
  host::test::write_text(folder.file("slot"), broken);
  EXPECT_EQ(FlightReader(folder.file("slot")).damaged_slots(), 1);
  EXPECT_EQ(FlightReader(folder.file("slot")).ticks(), 0U);
  broken = bytes;
  broken[100] ^= 1;
  host::test::write_text(folder.file("header"), broken);
  EXPECT_THROW(FlightReader(folder.file("header")), host::BadInput);
  host::test::write_text(folder.file("short"), bytes.substr(0, bytes.size() - 1));
  EXPECT_THROW(FlightReader(folder.file("short")), host::BadInput);
  EXPECT_FALSE(host::is_flight_file(folder.file("nothing")));
}

TEST_F(FlightRecorderTest, ExportsAsCsv) {
  auto recorder = open_or_die(path, 100);
  for (std::int64_t t = 0; t < 20; ++t)
    if (t != 7 && t != 8) recorder->write(tick_of(t));
  const auto result = host::export_recording(path, {.csv = {folder.file("f.csv"), "", folder.file("t.csv")}});
  EXPECT_EQ(result.tick_rows, 18);
  EXPECT_EQ(result.missing, 2);
  EXPECT_EQ(result.missing_ticks, "7..8");
  EXPECT_EQ(host::test::lines_of(folder.file("f.csv")).size(), 19U);
  EXPECT_THROW(host::export_recording(path, {.csv = {"", folder.file("s.csv"), ""}}), host::BadInput);
}

TEST_F(FlightRecorderTest, WhatTheNetworkLostIsFetchedOnce) {
  auto recorder = open_or_die(path, 100);
  for (std::int64_t t = 0; t < 60; ++t) recorder->write(tick_of(t));
  host::SessionTally tally;
  auto& ticks = tally[tally.find_or_add(77)].ticks;
  for (std::int64_t t = 10; t < 70; ++t)
    if ((t < 20 || t > 44) && t != 50 && (t < 60 || t > 62)) ticks.add(t);
  host::GapFiller filler;
  std::vector<std::int64_t> fetched;
  const auto emit = [&](const ligature_msg::tick_batch_t& batch) {
    EXPECT_EQ(batch.session, 77);
    EXPECT_EQ(batch.count, static_cast<std::int32_t>(batch.ticks.size()));
    for (const auto& tick : batch.ticks) fetched.push_back(tick.tick);
  };
  EXPECT_EQ(filler.fill(tally, emit), 0);  // nobody has said where the recorder is
  ligature_msg::status_t status{};
  status.session = 77;
  status.recorder_file = path;
  filler.note(status);
  EXPECT_EQ(filler.fill(tally, emit), 26);
  for (const auto t : fetched) EXPECT_TRUE(ticks.add(t)) << t;
  EXPECT_EQ(ticks.missing(), 3);  // 60..62: the recorder does not have them either
  EXPECT_EQ(filler.fill(tally, emit), 0);
}

/// Writes as fast as it can until it is killed; tells after each tick. Never returns.
[[noreturn]] void write_forever(const std::string& path, std::atomic<std::int64_t>& written) {
  auto opened = FlightRecorder::open(path, kFacts, 2000);
  if (std::holds_alternative<std::string>(opened)) _exit(1);
  for (std::int64_t t = 0;; ++t) {
    std::get<0>(opened)->write(tick_of(t));
    written.store(t + 1, std::memory_order_release);
  }
}

TEST_F(FlightRecorderTest, AHundredKillsLoseNothingThatWasWritten) {
  void* shared = mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(shared, MAP_FAILED);
  auto& written = *new (shared) std::atomic<std::int64_t>(0);
  std::mt19937 random(7);
  for (int kill_number = 0; kill_number < 100; ++kill_number) {
    written = 0;
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) write_forever(path, written);
    const auto until = static_cast<std::int64_t>(random() % 5000);
    while (written.load(std::memory_order_acquire) < until) ASSERT_EQ(waitpid(child, nullptr, WNOHANG), 0);
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    if (written == 0) continue;  // died before the file was complete
    const FlightReader reader(path);
    EXPECT_LE(reader.damaged_slots(), 1) << kill_number;
    const auto ticks = ticks_in(reader);
    ASSERT_FALSE(ticks.empty());
    EXPECT_GE(ticks.back() + 1, written) << kill_number;
    for (std::size_t i = 1; i < ticks.size(); ++i) ASSERT_EQ(ticks[i], ticks[i - 1] + 1);
    const auto wanted = std::min<std::int64_t>(ticks.back() + 1, 2000 - 1);  // a torn slot took the oldest one's place
    EXPECT_GE(static_cast<std::int64_t>(ticks.size()), wanted) << kill_number;
  }
  munmap(shared, 4096);
}

}  // namespace
}  // namespace ligature::telemetry
