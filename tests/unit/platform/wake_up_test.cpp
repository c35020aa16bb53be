#include "firmware/platform/wake_up.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace ligature::platform {
namespace {

TEST(WakeUp, OneThatComesWhileNobodyWaitsIsNotLost) {
  WakeUp wake;
  wake.wake();
  EXPECT_TRUE(wake.wait());  // returns because the wake-up was stored
}

TEST(WakeUp, TheEndStays) {
  WakeUp wake;
  wake.wake();
  wake.end();
  EXPECT_FALSE(wake.wait()) << "the end comes before a wake-up that is still there";
  wake.wake();
  EXPECT_FALSE(wake.wait());
}

// Plain integers are passed back and forth: each side must see what the other wrote before waking it (ThreadSanitizer
// checks this, too).
TEST(WakeUp, ShowsWhatWasWrittenBefore) {
  constexpr int kRounds = 5000;
  WakeUp there, back;
  int asked = 0, answered = 0;
  std::thread other([&] {
    while (there.wait()) {
      answered = asked + 1;
      back.wake();
    }
    back.end();
  });
  for (int i = 0; i < kRounds; ++i) {
    asked = 2 * i;
    there.wake();
    ASSERT_TRUE(back.wait());
    ASSERT_EQ(answered, 2 * i + 1);
  }
  there.end();
  EXPECT_FALSE(back.wait());
  other.join();
}

}  // namespace
}  // namespace ligature::platform
