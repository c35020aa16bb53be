#include <gtest/gtest.h>

#include "host/live_tally.hpp"
#include "synthetic_log.hpp"

namespace ligature::host {
namespace {

void add(LiveTally& tally, const ligature_msg::tick_batch_t& batch) { tally.add(kTicksChannel, test::encoded(batch)); }

TEST(LiveTally, NamesTheTicksThatNeverCame) {
  LiveTally tally;
  add(tally, test::batch_of(1, 0, 20));
  add(tally, test::batch_of(1, 40, 20));
  add(tally, test::batch_of(1, 61, 19));
  EXPECT_EQ(tally.sessions().missing(), 21);
  const auto summary = tally.summary();
  EXPECT_NE(summary.find("recorded 59 of 80 ticks, 21 lost"), std::string::npos) << summary;
  EXPECT_NE(summary.find("lost in session 1: ticks 20..39, 60 (21 in all"), std::string::npos) << summary;
}

TEST(LiveTally, CountsGarbageAndGoesOn) {
  LiveTally tally;
  const std::vector<std::byte> huge(5'000'000, std::byte{0xAB});
  tally.add(kTicksChannel, huge);
  tally.add(kTicksChannel, {});
  tally.add(kThreadChannel, test::encoded(test::batch_of(1, 0, 20)));
  add(tally, test::batch_of(1, 0, 20));
  EXPECT_EQ(tally.unreadable(), 3);
  EXPECT_EQ(tally.sessions().received(), 20);
  EXPECT_NE(tally.summary().find("unreadable: 3 messages"), std::string::npos);
}

TEST(LiveTally, SaysThatTheFirmwareWasRestarted) {
  LiveTally tally;
  add(tally, test::batch_of(1, 0, 20));
  add(tally, test::batch_of(2, 0, 20));
  EXPECT_EQ(tally.sessions().missing(), 0);
  EXPECT_NE(tally.summary().find("sessions: 2"), std::string::npos);
  EXPECT_NE(tally.progress_line(1.0, 1000.0).find("1 restarts"), std::string::npos);
}

TEST(LiveTally, TwoFirmwaresAtOnceAreNoRestart) {
  LiveTally tally;
  for (int i = 0; i < 3; ++i) {
    add(tally, test::batch_of(1, 20 * i, 20));
    add(tally, test::batch_of(2, 20 * i, 20));
  }
  EXPECT_NE(tally.summary().find("several firmwares sent at the same time"), std::string::npos) << tally.summary();
  EXPECT_EQ(tally.summary().find("restarted"), std::string::npos);
  LiveTally filled_late;  // ticks from the flight recorder, after a restart of the firmware
  add(filled_late, test::batch_of(1, 0, 20));
  add(filled_late, test::batch_of(1, 40, 20));
  add(filled_late, test::batch_of(2, 0, 20));
  add(filled_late, test::batch_of(1, 20, 20));
  EXPECT_NE(filled_late.summary().find("restarted"), std::string::npos);
}

TEST(LiveTally, SaysThatItJoinedLate) {
  LiveTally tally;
  add(tally, test::batch_of(1, 500, 20));
  EXPECT_EQ(tally.sessions().missing(), 0);
  EXPECT_NE(tally.summary().find("session 1 was joined at tick 500"), std::string::npos);
}

TEST(LiveTally, ManyHolesAreCutShort) {
  LiveTally tally;
  for (int i = 0; i < 30; ++i) add(tally, test::batch_of(1, 3 * i, 2));
  EXPECT_NE(tally.summary({}, 10).find("and 19 more holes (29 in all"), std::string::npos) << tally.summary({}, 10);
}

}  // namespace
}  // namespace ligature::host
