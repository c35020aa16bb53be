// GapCounter compared with the set of received numbers, counted by hand or by std::set.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "host/gap_counter.hpp"
#include "tests/support/random.hpp"

namespace ligature::host {
namespace {

using Ranges = std::vector<TickRange>;

TEST(GapCounter, CountsNothingLostInAWholeSequence) {
  GapCounter counter;
  for (int i = 5; i < 1005; ++i) EXPECT_TRUE(counter.add(i));
  EXPECT_EQ(counter.received(), 1000);
  EXPECT_EQ(counter.missing(), 0);
  EXPECT_EQ(counter.first(), 5);  // numbers before the first received one are not missing
  EXPECT_EQ(counter.last(), 1004);
}

TEST(GapCounter, NamesTheHoles) {
  GapCounter counter;
  for (const int n : {0, 1, 4, 5, 7}) counter.add(n);
  EXPECT_EQ(counter.missing(), 3);
  EXPECT_EQ(counter.missing_ranges(), (Ranges{{2, 3}, {6, 6}}));
}

TEST(GapCounter, ALateNumberClosesItsPlaceInTheHole) {
  GapCounter counter;
  for (const int n : {0, 9, 5}) EXPECT_TRUE(counter.add(n));
  EXPECT_EQ(counter.missing_ranges(), (Ranges{{1, 4}, {6, 8}}));
  EXPECT_EQ(counter.late(), 1);
  for (const int n : {1, 4, 2, 3}) EXPECT_TRUE(counter.add(n));
  EXPECT_EQ(counter.missing_ranges(), (Ranges{{6, 8}}));
  EXPECT_EQ(counter.duplicates(), 0);
}

TEST(GapCounter, TellsADuplicateFromALateNumber) {
  GapCounter counter;
  for (const int n : {0, 1, 3}) counter.add(n);
  EXPECT_FALSE(counter.add(1));
  EXPECT_FALSE(counter.add(3));
  EXPECT_TRUE(counter.add(2));
  EXPECT_FALSE(counter.add(2));
  EXPECT_EQ(counter.duplicates(), 3);
  EXPECT_EQ(counter.received(), 4);
  EXPECT_EQ(counter.missing(), 0);
}

TEST(GapCounter, ANumberBeforeTheFirstExtendsTheSequence) {
  GapCounter counter;
  for (const int n : {10, 7}) EXPECT_TRUE(counter.add(n));
  EXPECT_EQ(counter.first(), 7);
  EXPECT_EQ(counter.missing_ranges(), (Ranges{{8, 9}}));
}

TEST(GapCounter, AgreesWithASetOnShuffledLossyStreams) {
  test::Random random(1);
  for (int round = 0; round < 50; ++round) {
    std::vector<int> stream;
    for (int i = 0; i < 200; ++i)
      for (auto copies = random() % 3; copies > 0; --copies) stream.push_back(i);
    random.shuffle(stream);
    GapCounter counter;
    std::set<std::int64_t> came;
    for (const int n : stream) EXPECT_EQ(counter.add(n), came.insert(n).second);
    EXPECT_EQ(counter.received(), std::ssize(came));
    EXPECT_EQ(counter.duplicates(), std::ssize(stream) - std::ssize(came));
    EXPECT_EQ(counter.missing(), counter.last() - counter.first() + 1 - counter.received());
    std::int64_t in_ranges = 0;
    for (const auto& range : counter.missing_ranges()) {
      for (auto n = range.first; n <= range.last; ++n) EXPECT_FALSE(came.contains(n));
      in_ranges += range.size();
    }
    EXPECT_EQ(in_ranges, counter.missing());
  }
}

}  // namespace
}  // namespace ligature::host
