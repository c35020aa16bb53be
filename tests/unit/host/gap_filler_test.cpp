// GapFiller takes ticks that a recording lacks from the flight recorder's file: only ticks of the same session.
#include "host/gap_filler.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <memory>

#include "synthetic_log.hpp"

namespace ligature::host {
namespace {

/// Writes a flight recorder's file with ticks first .. last of a session, laid out as by protocol/recorder.
void write_flight(const std::string& path, std::int64_t session, std::int64_t first, std::int64_t last) {
  const auto header = std::make_unique<recorder::Header>();
  header->slot_bytes = recorder::slot_bytes_for(static_cast<std::size_t>(test::tick_of(0)._getEncodedSizeNoHash()));
  header->slots = last - first + 1;
  header->tick_hash = ligature_msg::tick_t::getHash();
  header->session = session;
  header->period_s = 1e-3;
  header->crc = recorder::crc_of(*header);
  std::vector<char> bytes(recorder::kHeaderBytes);
  std::memcpy(bytes.data(), header.get(), sizeof *header);
  for (std::int64_t number = first; number <= last; ++number) {
    const auto tick = test::tick_of(number);
    std::vector<std::byte> payload(static_cast<std::size_t>(tick._getEncodedSizeNoHash()));
    tick._encodeNoHash(payload.data(), 0, static_cast<int>(payload.size()));
    recorder::SlotHead head{static_cast<std::uint64_t>(number - first + 1), static_cast<std::uint32_t>(payload.size()),
                            0};
    head.crc = recorder::crc_of(head, payload);
    std::vector<char> slot(header->slot_bytes);
    std::memcpy(slot.data(), &head, sizeof head);
    std::ranges::transform(payload, slot.begin() + sizeof head, [](std::byte b) { return static_cast<char>(b); });
    bytes.insert(bytes.end(), slot.begin(), slot.end());
  }
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

class GapFillerTest : public ::testing::Test {
 protected:
  static constexpr std::int64_t kSession = 7'000, kOther = 8'000;

  /// Marks ticks first .. last of a session as received; gaps between such calls are missing ticks.
  void came(std::int64_t session, std::int64_t first, std::int64_t last) {
    const int index = tally.find_or_add(session);
    for (auto tick = first; tick <= last; ++tick) tally.add(index, tick);
  }
  void told(const std::string& name) {
    ligature_msg::status_t status{};
    status.recorder_file = name;
    filler.note(status);
  }
  /// Numbers of the fetched ticks, by session.
  std::map<std::int64_t, std::vector<std::int64_t>> fetched(GapFiller::Ends ends = GapFiller::Ends::kOpen) {
    std::map<std::int64_t, std::vector<std::int64_t>> ticks;
    std::int64_t sum = 0;
    const auto count = filler.fill(
        tally,
        [&](const ligature_msg::tick_batch_t& batch) {
          EXPECT_EQ(batch.count, std::ssize(batch.ticks));
          for (const auto& tick : batch.ticks) ticks[batch.session].push_back(tick.tick), ++sum;
        },
        ends);
    EXPECT_EQ(count, sum);
    return ticks;
  }
  test::TestFolder folder;
  std::string file = folder.file("flight.rec");
  SessionTally tally;
  GapFiller filler{{std::filesystem::path(file).parent_path()}};
};

using Ticks = std::map<std::int64_t, std::vector<std::int64_t>>;

TEST_F(GapFillerTest, FetchesTheMissingTicksAndNoOther) {
  write_flight(file, kSession, 0, 60);
  came(kSession, 0, 20);
  came(kSession, 24, 40);
  told(file);
  EXPECT_EQ(fetched(), (Ticks{{kSession, {21, 22, 23}}}));
  EXPECT_EQ(fetched(), Ticks{}) << "looked for once";
}

TEST_F(GapFillerTest, FetchesTheEndOfARunWhenTheRunHasEnded) {
  write_flight(file, kSession, 0, 43);
  came(kSession, 0, 40);
  told(file);
  EXPECT_EQ(fetched(), Ticks{});
  EXPECT_FALSE(filler.knows_end_of(kSession));
  EXPECT_EQ(fetched(GapFiller::Ends::kClosed), (Ticks{{kSession, {41, 42, 43}}}));
  EXPECT_TRUE(filler.knows_end_of(kSession));
}

/// Tick numbers start at zero in every session, so another run's ticks would fit into the gaps.
TEST_F(GapFillerTest, AFileOfAnotherSessionFillsNothing) {
  write_flight(file, kOther, 0, 60);
  came(kSession, 0, 20);
  came(kSession, 24, 40);
  told(file);
  EXPECT_EQ(fetched(GapFiller::Ends::kClosed), Ticks{});
  EXPECT_FALSE(filler.knows_end_of(kSession));
  came(kOther, 0, 10);
  came(kOther, 12, 60);
  told(file);
  EXPECT_EQ(fetched(), (Ticks{{kOther, {11}}}));
}

TEST_F(GapFillerTest, AFileThatTheFirmwareMovedAsideFillsItsOwnSession) {
  write_flight(file + ".previous", kSession, 0, 60);
  write_flight(file, kOther, 0, 60);
  came(kSession, 0, 20);
  came(kSession, 22, 40);
  came(kOther, 0, 30);
  came(kOther, 32, 40);
  told(file);
  EXPECT_EQ(fetched(), (Ticks{{kSession, {21}}, {kOther, {31}}}));
}

TEST_F(GapFillerTest, WhatLiesInNoFolderOfItsOwnIsNamedAndNotRead) {
  const test::TestFolder elsewhere;
  const std::string there = elsewhere.file("flight.rec");
  write_flight(there, kSession, 0, 60);
  came(kSession, 0, 20);
  came(kSession, 24, 40);
  told(there);
  EXPECT_EQ(fetched(GapFiller::Ends::kClosed), Ticks{});
  EXPECT_EQ(filler.outside(), there);
}

}  // namespace
}  // namespace ligature::host
