// The flight recorder's file and its reader: written ticks survive a killed process, and damaged slots are reported.
#include "firmware/telemetry/flight_slots.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <fstream>

#include "host/errors.hpp"
#include "host/export.hpp"
#include "host/flight_reader.hpp"
#include "host/gap_filler.hpp"
#include "tests/support/random.hpp"
#include "tests/unit/telemetry/flight_files.hpp"

namespace ligature::telemetry {
namespace {

using host::FlightReader;
using test::kFacts;
using test::record_of;
using test::ticks_in;

/// An open flight recorder file and its writer, without a thread of its own.
struct Open {
  Open(const std::string& path, std::int64_t count)
      : disk(test::disk_or_die(path, count)), slots(path, *disk, header_of(kFacts, count)) {}
  void write(const rt::TickRecord& record) { EXPECT_EQ(slots.append(std::span(&record, 1)), 0U); }
  void write_ticks(std::int64_t first, std::int64_t last) {
    std::vector<rt::TickRecord> records;
    for (auto t = first; t <= last; ++t) records.push_back(record_of(t));
    EXPECT_EQ(slots.append(records), 0U);
  }
  std::unique_ptr<Disk> disk;
  FlightSlots slots;
};

class FlightSlotsTest : public ::testing::Test {
 protected:
  host::test::TestFolder folder;
  std::string path = folder.file("flight.rec");
};

TEST_F(FlightSlotsTest, TicksReadBackWhileTheWriterLives) {
  Open file(path, 100);
  auto record = record_of(5);
  record.f_device_N[1][2] = -1.25;
  record.law_ns = 4711;
  file.write(record);
  file.write(record_of(6));
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

TEST_F(FlightSlotsTest, KeepsTheNewestWhenTheRingIsFull) {
  Open file(path, 50);
  file.write_ticks(0, 99);
  for (std::int64_t t = 100; t < 175; ++t) file.write(record_of(t));
  const auto ticks = ticks_in(FlightReader(path));
  ASSERT_EQ(ticks.size(), 50U);
  for (std::size_t i = 0; i < 50; ++i) EXPECT_EQ(ticks[i], static_cast<std::int64_t>(125 + i));
}

TEST_F(FlightSlotsTest, OneProcessAtATimeAndTheRunBeforeIsKept) {
  {
    Open file(path, 10);
    file.write(record_of(1));
    EXPECT_TRUE(std::holds_alternative<std::string>(FileDisk::make(path, 1000)));
  }
  const Open next(path, 10);
  EXPECT_EQ(ticks_in(FlightReader(path + ".previous")), std::vector<std::int64_t>{1});
}

TEST_F(FlightSlotsTest, RefusesAFolderThatIsNotThereAndADiskThatIsFull) {
  EXPECT_TRUE(std::holds_alternative<std::string>(FileDisk::make(folder.file("no/flight.rec"), 1000)));
  EXPECT_TRUE(std::holds_alternative<std::string>(FileDisk::make(path, std::size_t{1} << 60)));
  EXPECT_FALSE(std::filesystem::exists(path)) << "half a file was left";
}

TEST_F(FlightSlotsTest, LeavesAloneWhatNoRecorderWrote) {
  const std::string notes = folder.file("notes.txt"), link = folder.file("link"), name = folder.file("folder"),
                    pipe = folder.file("pipe");
  std::ofstream(notes) << "a user's own notes";
  std::filesystem::create_symlink(notes, link);
  std::filesystem::create_directory(name);
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);  // to open it would wait for a writer
  for (const auto& taken : {notes, link, name, pipe}) {
    EXPECT_TRUE(std::holds_alternative<std::string>(FileDisk::make(taken, 1000))) << taken;
    EXPECT_TRUE(std::filesystem::exists(std::filesystem::symlink_status(taken))) << taken;
    EXPECT_FALSE(std::filesystem::exists(std::filesystem::symlink_status(taken + ".previous"))) << taken;
  }
  const std::string begun = folder.file("begun");  // its process was killed before it wrote the header
  std::ofstream(begun) << std::string(1000, '\0');
  EXPECT_TRUE(std::holds_alternative<std::unique_ptr<FileDisk>>(FileDisk::make(begun, 1000)));
}

TEST_F(FlightSlotsTest, SavesTheTicksBeforeAFaultAndEndsBeforeTheDiskIsFull) {
  Open file(path, 100);
  EXPECT_EQ(file.slots.save_last(50, 11), "");  // nothing to save yet
  file.write_ticks(0, 129);
  const std::string saved = file.slots.save_last(50, 11);
  ASSERT_NE(saved, "");
  const FlightReader reader(saved);
  EXPECT_EQ(reader.fault(), 11);
  EXPECT_EQ(reader.damaged_slots(), 0);
  const auto ticks = ticks_in(reader);
  ASSERT_EQ(ticks.size(), 50U);
  EXPECT_EQ(ticks.front(), 80);
  EXPECT_EQ(ticks.back(), 129);
  for (int i = 1; i < FlightSlots::kMaxSaved; ++i) EXPECT_NE(file.slots.save_last(5, 11), "");
  EXPECT_EQ(file.slots.save_last(5, 11), "");
}

TEST_F(FlightSlotsTest, DamageIsFoundByTheCrc) {
  Open(path, 10).write(record_of(1));
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

TEST_F(FlightSlotsTest, ExportsAsCsv) {
  Open file(path, 100);
  file.write_ticks(0, 6);
  file.write_ticks(9, 19);
  const auto result = host::export_recording(path, {.csv = {folder.file("f.csv"), "", folder.file("t.csv")}});
  EXPECT_EQ(result.tick_rows, 18);
  EXPECT_EQ(result.missing, 2);
  EXPECT_EQ(result.missing_ticks, "7..8");
  EXPECT_EQ(host::test::lines_of(folder.file("f.csv")).size(), 19U);
  EXPECT_THROW(host::export_recording(path, {.csv = {"", folder.file("s.csv"), ""}}), host::BadInput);
}

TEST_F(FlightSlotsTest, WhatTheNetworkLostIsFetchedOnce) {
  Open file(path, 100);
  file.write_ticks(0, 49);
  host::SessionTally tally;
  auto& ticks = tally[tally.find_or_add(77)].ticks;
  for (std::int64_t t = 10; t < 70; ++t)
    if ((t < 20 || t > 44) && t != 50 && (t < 60 || t > 62)) ticks.add(t);
  host::GapFiller filler({folder.path()});
  std::vector<std::int64_t> fetched;
  const auto emit = [&](const ligature_msg::tick_batch_t& batch) {
    EXPECT_EQ(batch.session, 77);
    EXPECT_EQ(batch.count, static_cast<std::int32_t>(batch.ticks.size()));
    for (const auto& tick : batch.ticks) fetched.push_back(tick.tick);
  };
  EXPECT_EQ(filler.fill(tally, emit), 0);  // the recorder's file is not known yet
  ligature_msg::status_t status{};
  status.session = 77;
  status.recorder_file = path;
  filler.note(status);
  EXPECT_EQ(filler.fill(tally, emit), 25);
  for (const auto t : fetched) EXPECT_TRUE(ticks.add(t)) << t;
  fetched.clear();
  EXPECT_EQ(ticks.missing(), 4);  // ticks 50 and 60..62, which the recorder does not have
  EXPECT_EQ(filler.fill(tally, emit), 0);
  file.write_ticks(50, 59);  // the disk is later than the network
  EXPECT_EQ(filler.fill(tally, emit), 1);
  EXPECT_EQ(fetched, std::vector<std::int64_t>{50});
  EXPECT_TRUE(ticks.add(50));
  file.write_ticks(63, 70);  // the recorder has later ones, so 60..62 will never come
  EXPECT_EQ(filler.fill(tally, emit), 0);
  file.write_ticks(60, 62);
  EXPECT_EQ(filler.fill(tally, emit), 0);
}

/// Writes at full speed, 1 to 100 ticks at a time, and reports after each write, until it is killed. Never returns.
[[noreturn]] void write_forever(const std::string& path, std::atomic<std::int64_t>& written) {
  Open file(path, 2000);
  std::vector<rt::TickRecord> records;
  for (std::int64_t t = 0, n = 1;; t += n, n = n * 7 % 101) {
    records.clear();
    for (auto each = t; each < t + n; ++each) records.push_back(record_of(each));
    if (file.slots.append(records) != 0) _exit(1);
    written.store(t + n, std::memory_order_release);
  }
}

TEST_F(FlightSlotsTest, AHundredKillsLoseNothingThatWasWritten) {
  void* shared = mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(shared, MAP_FAILED);
  auto& written = *new (shared) std::atomic<std::int64_t>(0);
  ligature::test::Random random(7);
  for (int kill_number = 0; kill_number < 100; ++kill_number) {
    written = 0;
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) write_forever(path, written);
    const auto until = static_cast<std::int64_t>(random() % 5000);
    while (written.load(std::memory_order_acquire) < until) ASSERT_EQ(waitpid(child, nullptr, WNOHANG), 0);
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    if (written == 0) continue;  // killed before the file was complete
    const FlightReader reader(path);
    EXPECT_LE(reader.damaged_slots(), 1) << kill_number;
    const auto ticks = ticks_in(reader);
    ASSERT_FALSE(ticks.empty());
    EXPECT_GE(ticks.back() + 1, written) << kill_number;
    for (std::size_t i = 1; i < ticks.size(); ++i) ASSERT_EQ(ticks[i], ticks[i - 1] + 1);
    // A partly written slot has replaced the oldest tick.
    const auto wanted = std::min<std::int64_t>(ticks.back() + 1, 2000 - 1);
    EXPECT_GE(static_cast<std::int64_t>(ticks.size()), wanted) << kill_number;
  }
  munmap(shared, 4096);
}

}  // namespace
}  // namespace ligature::telemetry
