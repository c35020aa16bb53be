#include "sim_device/arrival_times.hpp"

#include <gtest/gtest.h>

#include "protocol/can/codec.hpp"
#include "protocol/can/nmt.hpp"

namespace ligature::sim {
namespace {

using std::chrono::milliseconds;
const Received kSync{can::sync_frame(), 0};
const Received kRpdo{can::encode(can::kWaist, can::Rpdo1{}), 0};
constexpr Time kPeriod = milliseconds(1);

TEST(ArrivalTimes, FramesOfOnePeriodCameNow) {
  const std::vector<Received> frames{kSync, kRpdo, kRpdo};
  EXPECT_EQ(arrival_times(frames, milliseconds(9), milliseconds(10), kPeriod, can::is_sync),
            std::vector<Time>(3, milliseconds(10)));
}

TEST(ArrivalTimes, PeriodsSleptThroughGetTheirBeatBack) {
  const std::vector<Received> frames{kRpdo, kSync, kRpdo, kSync, kRpdo, kSync};
  const std::vector<Time> expected{milliseconds(7), milliseconds(8), milliseconds(8),
                                   milliseconds(9), milliseconds(9), milliseconds(10)};
  EXPECT_EQ(arrival_times(frames, milliseconds(6), milliseconds(10), kPeriod, can::is_sync), expected);
}

// Two SYNCs within half a period: neither may be dated before the previous read.
TEST(ArrivalTimes, NothingCameBeforeTheLastLook) {
  const std::vector<Received> frames{kSync, kSync};
  const Time look = milliseconds(10) - std::chrono::microseconds(500);
  EXPECT_EQ(arrival_times(frames, look, milliseconds(10), kPeriod, can::is_sync),
            (std::vector<Time>{look, milliseconds(10)}));
}

}  // namespace
}  // namespace ligature::sim
