// What a missing or late sample means, over all orders of samples that a bus can bring.
#include "firmware/control/sample_age.hpp"

#include <gtest/gtest.h>

#include "tests/support/random.hpp"

namespace ligature::control {
namespace {

rt::HandReading reading_of(std::int32_t age, bool valid = true) {
  rt::HandReading r;
  r.valid = valid;
  r.age_ticks = age;
  return r;
}

TEST(SampleAge, BeforeTheFirstSampleNothingIsFreshOrOld) {
  SampleAge age;
  for (std::int64_t tick = 0; tick < 100; ++tick) {
    age.look(reading_of(static_cast<std::int32_t>(tick) + 2, false), tick, tick - 1);
    EXPECT_FALSE(age.is_fresh() || age.is_of_this_period() || age.is_too_old(20)) << tick;
    EXPECT_LT(age.taken(), 0);
  }
  age.look(reading_of(0), 100, 99);
  EXPECT_TRUE(age.is_fresh() && age.is_of_this_period());
}

/// A sample that is late by a period is new once, and was taken in the period before.
TEST(SampleAge, ALateSampleIsFreshOnceAndKeepsItsPeriod) {
  SampleAge age;
  age.look(reading_of(0), 10, 9);
  age.look(reading_of(1), 11, 10);  // nothing came
  EXPECT_FALSE(age.is_fresh());
  EXPECT_EQ(age.ticks(), 1);
  age.look(reading_of(1), 12, 11);  // the sample of 11 came
  EXPECT_TRUE(age.is_fresh());
  EXPECT_EQ(age.taken(), 11);
  EXPECT_FALSE(age.is_of_this_period());
}

/// The drives' side counts executed periods; lost ones are added here.
TEST(SampleAge, LostPeriodsMakeASampleOlder) {
  SampleAge age;
  age.look(reading_of(0), 10, 9);
  age.look(reading_of(1), 35, 10);  // 24 periods were lost
  EXPECT_FALSE(age.is_fresh());
  EXPECT_EQ(age.ticks(), 25);
  EXPECT_TRUE(age.is_too_old(25));
  EXPECT_FALSE(age.is_too_old(26));
}

/// For random losses, delays and lost periods: exactly the samples that arrive are fresh, each once, with its period.
TEST(SampleAge, TellsEachSampleOnceWithItsPeriod) {
  test::Random random(1);
  for (int run = 0; run < 200; ++run) {
    SampleAge age;
    std::int64_t last = -1, newest = -1;
    std::int32_t told = 2;
    for (std::int64_t tick = 0; tick < 300; tick += random.happens(0.05) ? 1 + random.any(1, 30) : 1) {
      const bool in_time = random.happens(0.6), late = !in_time && last >= 0 && last > newest && random.happens(0.5);
      told = in_time ? 0 : late ? 1 : told + 1;
      const std::int64_t before = newest;
      if (in_time) newest = tick;
      if (late) newest = last;
      age.look(reading_of(told, newest >= 0), tick, last);
      ASSERT_EQ(age.is_fresh(), newest != before) << tick;
      ASSERT_EQ(age.taken(), newest) << tick;
      ASSERT_EQ(age.ticks(), newest < 0 ? 0 : tick - newest) << tick;
      last = tick;
    }
  }
}

}  // namespace
}  // namespace ligature::control
