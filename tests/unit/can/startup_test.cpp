#include "protocol/can/startup.hpp"

#include <gtest/gtest.h>

#include "protocol/can/object_table.hpp"

namespace ligature::can {
namespace {

TEST(Startup, WritesOnlyObjectsThatExistWithTheirOwnWidth) {
  for (const NodeId node : profile::kJointNodes) {
    const ObjectTable table = object_table(node);
    for (const SdoWrite& w : startup_plan(node)) {
      const ObjectRow* row = table.find(w.object);
      ASSERT_NE(row, nullptr) << std::hex << w.object.index;
      EXPECT_EQ(row->access, Access::kReadWrite) << std::hex << w.object.index;
      EXPECT_EQ(bytes_of(row->type), w.bytes) << std::hex << w.object.index;
    }
  }
}

TEST(Startup, ChangesAMappingOnlyWhileItsPdoIsOff) {
  for (const NodeId node : profile::kJointNodes) {
    bool rpdo_on = true, tpdo_on = true;
    for (const SdoWrite& w : startup_plan(node)) {
      if (w.object == od::kRpdo1CobId) rpdo_on = (w.value >> 31U) == 0;
      if (w.object == od::kTpdo1CobId) tpdo_on = (w.value >> 31U) == 0;
      EXPECT_FALSE(w.object.index == od::kRpdo1MapCount.index && rpdo_on);
      EXPECT_FALSE(w.object.index == od::kTpdo1MapCount.index && tpdo_on);
    }
    EXPECT_TRUE(rpdo_on && tpdo_on);
  }
}

std::uint32_t written(const StartupPlan& plan, Object object) {
  for (const SdoWrite& w : plan) {
    if (w.object == object) return w.value;
  }
  return 0;
}

TEST(Startup, SetsBothWatchdogs) {
  const StartupPlan plan =
      startup_plan(kWaist, {.rpdo_timeout_ms = 35, .heartbeat_timeout_ms = 250, .heartbeat_period_ms = 80});
  EXPECT_EQ(written(plan, od::kRpdo1EventTimer), 35U);
  EXPECT_EQ(written(plan, od::kConsumerHeartbeat), consumer_heartbeat_value(kMasterNode, 250));
  EXPECT_EQ(written(plan, od::kProducerHeartbeat), 80U);
}

TEST(Startup, AWatchdogThatNobodyNamesIsTwentyMillisecondsOrThreeHeartbeats) {
  const StartupPlan plan = startup_plan(kWaist);
  EXPECT_EQ(written(plan, od::kRpdo1EventTimer), 20U);
  EXPECT_EQ(written(plan, od::kConsumerHeartbeat), consumer_heartbeat_value(kMasterNode, 300));
  EXPECT_EQ(written(plan, od::kProducerHeartbeat), 100U);
}

}  // namespace
}  // namespace ligature::can
