// The ring buffer, used by one thread and by two threads; for two threads the tsan preset checks for data races.
#include "firmware/rt/spsc_ring.hpp"

#include <gtest/gtest.h>

#include <array>
#include <thread>

namespace ligature::rt {
namespace {

TEST(SpscRing, KeepsOrderAndForgetsNothingWhileNotFull) {
  SpscRing<int> ring(3);
  int value = 0;
  EXPECT_FALSE(ring.pop(value));
  for (int lap = 0; lap < 5; ++lap) {  // several times around the ring
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(ring.push(10 * lap + i));
    for (int i = 0; i < 3; ++i) {
      ASSERT_TRUE(ring.pop(value));
      EXPECT_EQ(value, 10 * lap + i);
    }
  }
  EXPECT_EQ(ring.dropped(), 0U);
}

TEST(SpscRing, DropsTheNewestWhenFullAndCountsIt) {
  SpscRing<int> ring(2);
  EXPECT_TRUE(ring.push(1));
  EXPECT_TRUE(ring.push(2));
  EXPECT_FALSE(ring.push(3));
  EXPECT_EQ(ring.dropped(), 1U);
  int value = 0;
  ASSERT_TRUE(ring.pop(value));
  EXPECT_EQ(value, 1);
  EXPECT_TRUE(ring.push(4));
}

TEST(SpscRing, DeliversEveryValueWholeBetweenTwoThreads) {
  struct Wide {
    std::array<std::uint64_t, 16> words{};
  };
  constexpr std::uint64_t kCount = 200000;
  SpscRing<Wide> ring(64);
  std::thread producer([&] {
    for (std::uint64_t i = 1; i <= kCount;) {
      Wide w;
      w.words.fill(i);
      if (ring.push(w)) {
        ++i;
      } else {
        std::this_thread::yield();
      }
    }
  });
  std::uint64_t torn = 0;
  for (std::uint64_t expected = 1; expected <= kCount;) {
    Wide w;
    if (!ring.pop(w)) {
      std::this_thread::yield();
      continue;
    }
    for (const auto word : w.words) torn += word != expected;
    ++expected;
  }
  producer.join();
  EXPECT_EQ(torn, 0U);
}

}  // namespace
}  // namespace ligature::rt
