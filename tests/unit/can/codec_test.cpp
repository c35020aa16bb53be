#include "protocol/can/codec.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <span>

#include "protocol/can/local_wire.hpp"
#include "tests/support/random.hpp"

namespace ligature::can {
namespace {

template <class Int>
Int pick(test::Random& random) {  // extreme values as often as ordinary ones
  switch (random() % 4) {
    case 0:
      return std::numeric_limits<Int>::min();
    case 1:
      return std::numeric_limits<Int>::max();
    case 2:
      return Int{0};
    default:
      return static_cast<Int>(random());
  }
}

TEST(Codec, Tpdo1SurvivesTheRoundTrip) {
  test::Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const NodeId node = profile::kJointNodes[random() % 3];
    Tpdo1 p{pick<std::uint16_t>(random), pick<std::int32_t>(random), 0, 0};
    if (profile::has_stylus_buttons(node)) {
      p.buttons = pick<std::uint16_t>(random);
    } else {
      p.torque_permille = pick<std::int16_t>(random);
    }
    EXPECT_EQ(decode_tpdo1(node, encode(node, p)), p);
  }
}

TEST(Codec, Rpdo1SurvivesTheRoundTrip) {
  test::Random random(2);
  for (int i = 0; i < 20000; ++i) {
    const NodeId node = profile::kJointNodes[random() % 3];
    const Rpdo1 p{pick<std::uint16_t>(random), pick<std::int16_t>(random)};
    EXPECT_EQ(decode_rpdo1(node, encode(node, p)), p);
  }
}

TEST(Codec, RefusesAnotherNodesFrameAndAnotherLength) {
  Frame f = encode(kWaist, Rpdo1{15, 100});
  EXPECT_FALSE(decode_rpdo1(kShoulder, f));
  EXPECT_FALSE(decode_tpdo1(kWaist, f));
  f.dlc = 3;
  EXPECT_FALSE(decode_rpdo1(kWaist, f));
}

TEST(Codec, TorqueAndButtonsTravelOnlyWhereTheMapSaysSo) {
  const Tpdo1 both{0, 0, -5, 3};
  EXPECT_EQ(decode_tpdo1(kWaist, encode(kWaist, both)), (Tpdo1{0, 0, -5, 0}));
  EXPECT_EQ(decode_tpdo1(kElbow, encode(kElbow, both)), (Tpdo1{0, 0, 0, 3}));
}

TEST(LocalWire, AnyFrameSurvivesTheRoundTrip) {
  test::Random random(3);
  for (int i = 0; i < 5000; ++i) {
    Frame f{static_cast<std::uint32_t>(random()) & kMaxId, static_cast<std::uint8_t>(random() % 9), {}};
    for (std::size_t b = 0; b < f.dlc; ++b) f.data[b] = static_cast<std::uint8_t>(random());
    EXPECT_EQ(from_packet(to_packet(f)), f);
  }
}

TEST(LocalWire, AnyFrameOfAnFdNetworkSurvivesTheRoundTrip) {
  test::Random random(4);
  for (int i = 0; i < 5000; ++i) {
    Frame f{static_cast<std::uint32_t>(random()) & kMaxId, fd_length(random() % 65), {}};
    if (random.happens(0.5)) f.id = kExtendedBit | (static_cast<std::uint32_t>(random()) & kMaxExtendedId);
    f.format = f.dlc > kMaxDlc || random.happens(0.5) ? Format::kFdFast : Format::kClassic;
    if (f.format != Format::kClassic && random.happens(0.5)) f.format = Format::kFd;
    for (std::size_t b = 0; b < f.dlc; ++b) f.data[b] = static_cast<std::uint8_t>(random());
    const LocalPacket p = to_packet(f);
    EXPECT_EQ(p.size(), f.format == Format::kClassic ? 16U : 72U);
    EXPECT_EQ(from_packet(p, Network::kFd), f);
    const bool is_classic = f.format == Format::kClassic && !is_extended(f);
    EXPECT_EQ(from_packet(p).has_value(), is_classic) << "a reader on a classic bus";
  }
}

TEST(LocalWire, RefusesWhatIsNoFdFrame) {
  LocalPacket p = to_packet(Frame{0x100, 12, {}, Format::kFdFast});
  EXPECT_TRUE(from_packet(p, Network::kFd));
  EXPECT_FALSE(from_packet(std::span(p).first(71), Network::kFd));
  p[4] = 13;  // there is no such length
  EXPECT_FALSE(from_packet(p, Network::kFd));
  p[4] = 12;
  p[3] = 0x40;  // there are no remote frames
  EXPECT_FALSE(from_packet(p, Network::kFd));
  p[3] = 0x20;  // an error frame
  EXPECT_FALSE(from_packet(p, Network::kFd));
  p[3] = 0x00;
  p[2] = 0x01;  // more than 11 bits without the flag
  EXPECT_FALSE(from_packet(p, Network::kFd));
}

TEST(FdLength, IsTheNextOneThatThereIs) {
  EXPECT_EQ(fd_length(0), 0);
  EXPECT_EQ(fd_length(8), 8);
  EXPECT_EQ(fd_length(9), 12);
  EXPECT_EQ(fd_length(24), 24);
  EXPECT_EQ(fd_length(33), 48);
  EXPECT_EQ(fd_length(49), 64);
}

TEST(LocalWire, RefusesWhatIsNoDataFrame) {
  LocalPacket p = to_packet(Frame{0x181, 8, {}});
  EXPECT_FALSE(from_packet(std::span(p).first(15)));
  p[4] = 9;  // more data bytes than classic CAN allows
  EXPECT_FALSE(from_packet(p));
  p[4] = 8;
  p[3] = 0x80;  // the flag for extended identifiers
  EXPECT_FALSE(from_packet(p));
}

}  // namespace
}  // namespace ligature::can
