#include "protocol/can/bit_time.hpp"

#include <gtest/gtest.h>

#include <string_view>

#include "protocol/can/codec.hpp"
#include "protocol/can/nmt.hpp"
#include "tests/support/random.hpp"

namespace ligature::can {
namespace {

TEST(BitTime, CrcIsThatOfTheStandard) {  // check value of CRC-15/CAN for the text "123456789"
  StuffCounter counter;
  for (const char c : std::string_view("123456789")) counter.push(static_cast<std::uint32_t>(c), 8);
  EXPECT_EQ(counter.crc(), 0x059EU);
}

TEST(BitTime, CountsStuffBitsOfAFrameDoneByHand) {
  // Identifier 0 without data: 19 zero bits and a zero CRC give 34 equal bits; a bit is stuffed after every fifth: 6.
  EXPECT_EQ(frame_bits(Frame{0, 0, {}}), 47U + 6U);
}

TEST(BitTime, LiesBetweenNoStuffingAndTheWorstCase) {
  test::Random random(7);
  for (int i = 0; i < 20000; ++i) {
    Frame f{static_cast<std::uint32_t>(random()) & kMaxId, static_cast<std::uint8_t>(random() % 9), {}};
    const bool runs = i % 2 == 0;  // every second frame has long runs of equal bits, which need many stuff bits
    for (std::size_t b = 0; b < f.dlc; ++b)
      f.data[b] = static_cast<std::uint8_t>(runs ? (random() % 2) * 0xFF : random());
    EXPECT_GE(frame_bits(f), min_frame_bits(f.dlc));
    EXPECT_LE(frame_bits(f), max_frame_bits(f.dlc));
  }
}

TEST(BitTime, OneTickTakesBetween617And745Microseconds) {
  test::Random random(8);
  for (int i = 0; i < 2000; ++i) {
    unsigned bits = frame_bits(sync_frame());
    for (const NodeId node : profile::kJointNodes) {
      bits +=
          frame_bits(encode(node, Tpdo1{static_cast<std::uint16_t>(random()), static_cast<std::int32_t>(random()),
                                        static_cast<std::int16_t>(random()), static_cast<std::uint16_t>(random())}));
      bits +=
          frame_bits(encode(node, Rpdo1{static_cast<std::uint16_t>(random()), static_cast<std::int16_t>(random())}));
    }
    EXPECT_GE(bits, 617U);
    EXPECT_LE(bits, 745U);
  }
}

}  // namespace
}  // namespace ligature::can
