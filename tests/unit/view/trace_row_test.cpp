#include "host/view/trace_row.hpp"

#include <gtest/gtest.h>

#include "host/tick_statistics.hpp"
#include "host/view/ring.hpp"
#include "tests/unit/host/synthetic_log.hpp"

namespace ligature::host::view {
namespace {

TEST(TraceRow, HoldsTheMessagesOwnNumbers) {
  auto tick = test::tick_of(1234567);
  const double f[3] = {0.1, -1.0 / 3.0, 2e-17};
  std::copy(f, f + 3, tick.f_device_N[1]);
  tick.execution_ns = 987654;
  const TraceRow row = trace_row(tick);
  EXPECT_EQ(row[kTick], 1234567.0);
  EXPECT_EQ(row[kRightY], -1.0 / 3.0);
  EXPECT_EQ(row[kRight], magnitude(f));  // bit by bit what export writes
  EXPECT_EQ(row[kExecution_ns], 987654.0);
}

TEST(BinMaker, NeverHidesASpikeNorAFlag) {
  BinMaker maker;
  TraceBin done;
  for (std::int64_t i = 0; i < kTicksPerBin; ++i) {
    auto tick = test::tick_of(i);
    if (i == 17) tick.f_device_N[0][2] = 3.0;
    if (i == 20) tick.flags = 2;
    if (i == 30) tick.flags = 16;
    EXPECT_FALSE(maker.add(trace_row(tick), done));
  }
  ASSERT_TRUE(maker.add(trace_row(test::tick_of(kTicksPerBin)), done));
  EXPECT_EQ(done.high[kLeft], 3.0F);
  EXPECT_EQ(done.low[kLeft], 0.0F);
  EXPECT_EQ(done.high[kFlags], 18.0F);
  EXPECT_EQ(done.high[kTick], 0.0F);
}

TEST(BinMaker, NumbersItsBinsExactlyForYears) {
  constexpr std::int64_t kYear = 31'536'000'000;
  for (const std::int64_t start : {std::int64_t{0}, std::int64_t{1} << 31, std::int64_t{1} << 32, kYear, 10 * kYear}) {
    BinMaker maker;
    TraceBin done;
    std::int64_t wanted = start / kTicksPerBin;
    for (std::int64_t tick = start; tick < start + 10 * kTicksPerBin; ++tick) {
      if (!maker.add(trace_row(test::tick_of(tick)), done)) continue;
      const auto found =
          static_cast<std::int64_t>(done.low[kTick]) + static_cast<std::int64_t>(done.high[kTick]) * kBinNumberPart;
      EXPECT_EQ(found, wanted++);
    }
    EXPECT_GE(wanted - start / kTicksPerBin, 9);
  }
}

TEST(Ring, KeepsTheLastAndCountsAll) {
  Ring<int> ring(3);
  for (int i = 0; i < 5; ++i) ring.push(i);
  EXPECT_EQ(ring.begin(), 2);
  EXPECT_EQ(ring.end(), 5);
  EXPECT_EQ(ring[4], 4);
  ring.clear();
  EXPECT_EQ(ring.begin(), 5);
  ring.push(9);
  EXPECT_EQ(ring[5], 9);
}

}  // namespace
}  // namespace ligature::host::view
