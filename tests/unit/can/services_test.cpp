#include <gtest/gtest.h>

#include "protocol/can/emcy.hpp"
#include "protocol/can/heartbeat.hpp"
#include "protocol/can/nmt.hpp"
#include "protocol/can/sdo.hpp"
#include "tests/support/random.hpp"

namespace ligature::can {
namespace {

TEST(CobIds, EveryServiceOfEveryNodeIsRecognised) {
  for (int n = 1; n <= kMaxNodeId; ++n) {
    const NodeId node{static_cast<std::uint8_t>(n)};
    for (const Service s : {Service::kEmcy, Service::kTpdo1, Service::kRpdo1, Service::kSdoResponse,
                            Service::kSdoRequest, Service::kHeartbeat}) {
      EXPECT_EQ(address_of(cob_id(s, node).value), (Address{s, node}));
    }
  }
}

TEST(Nmt, CommandsAreForOneNodeOrAll) {
  const auto all = decode_nmt(encode_nmt(NmtCommand::kStart));
  ASSERT_TRUE(all);
  EXPECT_TRUE(all->is_for(kWaist) && all->is_for(kElbow));
  const auto one = decode_nmt(encode_nmt(NmtCommand::kStop, kShoulder));
  ASSERT_TRUE(one);
  EXPECT_TRUE(one->is_for(kShoulder));
  EXPECT_FALSE(one->is_for(kWaist));
  EXPECT_FALSE(decode_nmt(Frame{0, 2, {0x55, 0}}));  // 0x55 is no NMT command
  EXPECT_FALSE(decode_nmt(Frame{0, 1, {0x01}}));
}

TEST(Heartbeat, RefusesUnknownStatesAndLengths) {
  EXPECT_EQ(decode_heartbeat(encode(Heartbeat{kMasterNode, NmtState::kPreOperational})),
            (Heartbeat{kMasterNode, NmtState::kPreOperational}));
  EXPECT_FALSE(decode_heartbeat(Frame{0x701, 1, {0x33}}));
  EXPECT_FALSE(decode_heartbeat(Frame{0x701, 2, {0x05}}));
  EXPECT_EQ(consumer_heartbeat_value(kMasterNode, 300), 0x007F012CU);
}

TEST(Emergency, ItsNumbersAreThoseOfCiA301) {
  EXPECT_EQ(emcy::kGenericBit, 0x01);
  EXPECT_EQ(emcy::kCommunicationBit, 0x10);
  EXPECT_EQ(emcy::kHeartbeatLost, 0x8130);
  EXPECT_EQ(emcy::kRpdoTimeout, 0x8250);
}

TEST(Emergency, IsLittleEndian) {
  EXPECT_EQ(encode(Emergency{kWaist, emcy::kRpdoTimeout, 0x11}).data, (decltype(Frame::data){0x50, 0x82, 0x11}));
}

TEST(Sdo, EveryTransferSurvivesTheRoundTrip) {
  test::Random random(4);
  for (int i = 0; i < 5000; ++i) {
    const NodeId node{static_cast<std::uint8_t>(1 + random() % 127)};
    const Object object{static_cast<std::uint16_t>(random()), static_cast<std::uint8_t>(random())};
    const auto bytes = static_cast<std::uint8_t>(1 + random() % 4);
    const std::uint32_t value = bytes == 4 ? static_cast<std::uint32_t>(random())
                                           : static_cast<std::uint32_t>(random()) & ((1U << (8U * bytes)) - 1U);
    for (const Sdo& s :
         {Sdo{SdoKind::kWrite, node, object, value, bytes}, Sdo{SdoKind::kValue, node, object, value, bytes},
          Sdo{SdoKind::kRead, node, object, 0, 0}, Sdo{SdoKind::kWritten, node, object, 0, 0},
          Sdo{SdoKind::kAbort, node, object, sdo_abort::kNoSuchObject, 0}}) {
      EXPECT_EQ(decode_sdo(encode(s)), s);
    }
  }
}

TEST(Sdo, BytesAreThoseOfTheStandard) {
  const Frame f = sdo_write(kWaist, od::kConsumerHeartbeat, 0x007F012C, 4);
  EXPECT_EQ(f.id, 0x601U);
  EXPECT_EQ(f.data, (decltype(Frame::data){0x23, 0x16, 0x10, 0x01, 0x2C, 0x01, 0x7F, 0x00}));
  EXPECT_EQ(sdo_read(kWaist, od::kStatusword).data[0], 0x40);
}

TEST(Sdo, SegmentedTransfersAreNamedUnsupported) {
  // A download that is not expedited.
  EXPECT_EQ(decode_sdo(Frame{0x601, 8, {0x21, 0x00, 0x10}})->kind, SdoKind::kUnsupported);
  EXPECT_FALSE(decode_sdo(Frame{0x601, 7, {0x40}}));
}

}  // namespace
}  // namespace ligature::can
