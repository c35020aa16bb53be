#include <gtest/gtest.h>

#include "host/session_tally.hpp"

namespace ligature::host {
namespace {

TEST(SessionTally, ARestartCountsFromItsOwnFirstTick) {
  SessionTally tally;
  for (int i = 0; i < 100; ++i) tally[tally.find_or_add(1)].ticks.add(i);
  for (int i = 0; i < 50; ++i) tally[tally.find_or_add(2)].ticks.add(i);
  EXPECT_EQ(tally.restarts(), 1U);
  EXPECT_EQ(tally.received(), 150);
  EXPECT_EQ(tally.missing(), 0);
  EXPECT_EQ(tally.duplicates(), 0);
}

TEST(SessionTally, TwoFirmwaresAtOnceAreNoGaps) {
  SessionTally tally;
  for (int i = 0; i < 100; ++i) {
    tally[tally.find_or_add(1)].ticks.add(i);
    tally[tally.find_or_add(2)].ticks.add(5000 + i);
  }
  EXPECT_EQ(tally.missing(), 0);
  EXPECT_EQ(tally.sessions().size(), 2U);
}

TEST(SessionTally, RefusesMoreSessionsThanARigCouldStart) {
  SessionTally tally;
  for (std::size_t i = 0; i < SessionTally::kMaxSessions; ++i) EXPECT_GE(tally.find_or_add(static_cast<int>(i)), 0);
  EXPECT_EQ(tally.find_or_add(-1), -1);
  EXPECT_EQ(tally.find_or_add(7), 7);  // known sessions are still found
}

}  // namespace
}  // namespace ligature::host
