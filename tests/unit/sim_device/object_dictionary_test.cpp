#include "sim_device/object_dictionary.hpp"

#include <gtest/gtest.h>

namespace ligature::sim {
namespace {

using can::Object;
using can::Sdo;
using can::SdoKind;
namespace od = can::od;

Sdo write(Object object, std::uint32_t value, std::uint8_t bytes) {
  return {SdoKind::kWrite, can::kWaist, object, value, bytes};
}
Sdo read(Object object) { return {SdoKind::kRead, can::kWaist, object, 0, 0}; }

std::uint32_t abort_code(const std::optional<Sdo>& answer) {
  return answer && answer->kind == SdoKind::kAbort ? answer->value : 0;
}

TEST(ObjectDictionary, ReadsWhatWasWritten) {
  ObjectDictionary d(can::kWaist);
  EXPECT_EQ(d.serve(write(od::kProducerHeartbeat, 123, 2))->kind, SdoKind::kWritten);
  const auto answer = d.serve(read(od::kProducerHeartbeat));
  EXPECT_EQ(*answer, (Sdo{SdoKind::kValue, can::kWaist, od::kProducerHeartbeat, 123, 2}));
  d.reset_communication();
  EXPECT_EQ(d.value(od::kProducerHeartbeat), 0);
}

TEST(ObjectDictionary, NegativeValuesKeepTheirSign) {
  ObjectDictionary d(can::kWaist);
  EXPECT_EQ(d.serve(write(od::kQuickStopOption, 0xFFFF, 2))->kind, SdoKind::kWritten);
  EXPECT_EQ(d.value(od::kQuickStopOption), -1);
  EXPECT_EQ(d.serve(read(od::kQuickStopOption))->value, 0xFFFFU);
}

TEST(ObjectDictionary, RefusesWithTheCodeOfTheStandard) {
  ObjectDictionary d(can::kWaist);
  EXPECT_EQ(abort_code(d.serve(read({0x5FFF, 0}))), can::sdo_abort::kNoSuchObject);
  EXPECT_EQ(abort_code(d.serve(read({0x1018, 9}))), can::sdo_abort::kNoSuchSubIndex);
  EXPECT_EQ(abort_code(d.serve(write(od::kStatusword, 1, 2))), can::sdo_abort::kReadOnly);
  EXPECT_EQ(abort_code(d.serve(write(od::kProducerHeartbeat, 1, 4))), can::sdo_abort::kWrongLength);
  EXPECT_EQ(abort_code(d.serve(write(od::kModeOfOperation, 8, 1))), can::sdo_abort::kValueOutOfRange);
  EXPECT_EQ(abort_code(d.serve(write(od::kMaxTorque, 3001, 2))), can::sdo_abort::kValueOutOfRange);
  EXPECT_EQ(abort_code(d.serve(write(od::kTargetTorque, 100, 2))), can::sdo_abort::kWrongDeviceState);
  EXPECT_EQ(abort_code(d.serve({SdoKind::kUnsupported, can::kWaist, od::kStatusword, 0, 0})),
            can::sdo_abort::kUnknownCommand);
  EXPECT_FALSE(d.serve({SdoKind::kAbort, can::kWaist, od::kStatusword, 0, 0}));
}

TEST(ObjectDictionary, AMappingChangesOnlyWhileThePdoIsOffAndOnlyToWhatFits) {
  ObjectDictionary d(can::kWaist);
  const std::uint32_t id = 0x181;
  EXPECT_EQ(abort_code(d.serve(write(od::kTpdo1MapCount, 0, 1))), can::sdo_abort::kWrongDeviceState);
  EXPECT_EQ(d.serve(write(od::kTpdo1CobId, 0x80000000U | id, 4))->kind, SdoKind::kWritten);
  EXPECT_FALSE(d.is_pdo_on(can::Pdo::kTpdo1));
  EXPECT_EQ(d.serve(write(od::kTpdo1MapCount, 0, 1))->kind, SdoKind::kWritten);
  EXPECT_EQ(abort_code(d.serve(write({0x1A00, 1}, 0x60640020, 4))), can::sdo_abort::kCannotBeMapped);
  EXPECT_EQ(d.serve(write({0x1A00, 1}, 0x60410010, 4))->kind, SdoKind::kWritten);
  EXPECT_EQ(d.serve(write(od::kTpdo1MapCount, 3, 1))->kind, SdoKind::kWritten);
  EXPECT_EQ(d.serve(write(od::kTpdo1CobId, id, 4))->kind, SdoKind::kWritten);
  EXPECT_TRUE(d.is_pdo_on(can::Pdo::kTpdo1));
}

}  // namespace
}  // namespace ligature::sim
