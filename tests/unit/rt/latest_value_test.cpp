// The triple buffer: the reader gets the newest value, never a mixture of two, never an older one than before.
#include "firmware/rt/latest_value.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <thread>

namespace ligature::rt {
namespace {

TEST(LatestValue, GivesTheNewestAndSaysWhetherThereIsNews) {
  LatestValue<int> latest;
  EXPECT_FALSE(latest.refresh());
  EXPECT_EQ(latest.front(), 0);
  latest.store(1);
  latest.store(2);
  EXPECT_TRUE(latest.refresh());
  EXPECT_EQ(latest.front(), 2);
  EXPECT_FALSE(latest.refresh());
  EXPECT_EQ(latest.front(), 2);
}

TEST(LatestValue, IsNeverTornAndNeverGoesBackBetweenTwoThreads) {
  struct Wide {
    std::array<std::uint64_t, 64> words{};
  };
  LatestValue<Wide> latest;
  constexpr std::uint64_t kCount = 100000;
  std::thread writer([&] {
    for (std::uint64_t i = 1; i <= kCount; ++i) {
      latest.back().words.fill(i);
      latest.publish();
    }
  });
  std::uint64_t last = 0, torn = 0, backwards = 0;
  while (last < kCount) {
    if (!latest.refresh()) {
      std::this_thread::yield();
      continue;
    }
    const auto first = latest.front().words[0];
    for (const auto word : latest.front().words) torn += word != first;
    backwards += first < last;
    last = first;
  }
  writer.join();
  EXPECT_EQ(torn, 0U);
  EXPECT_EQ(backwards, 0U);
}

}  // namespace
}  // namespace ligature::rt
