// Lost CAN frames must cause a fault within bounded time when so many are lost that the force can no longer be correct.
// On a good bus they must cause none. bad_bus_study draws each share 300 times: docs/measurements/fault-matrix.md.
#include "tests/integration/virtual_rig/bad_bus.hpp"

#include <gtest/gtest.h>

#include "tests/support/random.hpp"

namespace ligature {
namespace {

void expect_sound(const BadBusEnd& end) {
  EXPECT_LE(end.peak_N, 3.4);
  EXPECT_FALSE(end.pushed_after) << "a fault takes all torque";
}

TEST(BadBus, EveryShareOfLostFramesFromAFourthOnIsAFaultInBoundedTime) {
  test::Random random(27);
  for (int percent = 25; percent <= 100; percent += 5) {
    for (const auto& [left, right] : {std::pair{true, false}, {false, true}, {true, true}}) {
      const std::uint64_t seed = random();
      SCOPED_TRACE(testing::Message() << percent << " % " << left << right << ", seed " << seed);
      const auto end = end_of({.lost = 0.01 * percent, .left = left, .right = right}, seed);
      expect_sound(end);
      EXPECT_NE(end.fault, 0);
      EXPECT_LE(end.to_zero, ticks_to_zero_at(0.01 * percent));
    }
  }
}

TEST(BadBus, ASixthOfTheFramesIsOneToo) {
  test::Random random(28);
  for (int k = 0; k < 4; ++k) {
    const std::uint64_t seed = random();
    const auto end = end_of({.lost = 0.167, .left = k % 2 == 0, .right = k % 2 == 1, .ticks = 2200}, seed);
    expect_sound(end);
    EXPECT_NE(end.fault, 0) << seed;
  }
}

TEST(BadBus, AnHonestRigHasNoAlarm) {
  test::Random random(29);
  for (const double lost : {0.0, 0.01, 0.02, 0.05}) {
    for (int k = 0; k < 3; ++k) {
      const std::uint64_t seed = random();
      const auto end = end_of({.lost = lost, .left = true, .right = true, .ticks = 1000}, seed);
      expect_sound(end);
      EXPECT_NE(end.fault, 17) << lost << ", seed " << seed;
    }
  }
}

TEST(BadBus, WrongBitsInOneFrameOfAHundredAreAFault) {
  test::Random random(30);
  for (int k = 0; k < 10; ++k) {
    const std::uint64_t seed = random();
    const auto end = end_of({.wrong = 0.01, .left = k % 2 == 0, .right = k % 2 == 1, .ticks = 1500}, seed);
    EXPECT_FALSE(end.pushed_after);
    EXPECT_NE(end.fault, 0) << seed;
    EXPECT_LE(end.peak_N, 3.4) << seed;
  }
}

}  // namespace
}  // namespace ligature
