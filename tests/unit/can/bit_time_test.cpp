#include "protocol/can/bit_time.hpp"

#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "protocol/can/codec.hpp"
#include "protocol/can/fd_time.hpp"
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

/// The same by another way: the frame as text, with the stuff bits written into it.
BitCount by_text(const Frame& f) {
  const auto text = [](std::uint64_t value, int bits) {
    std::string s;
    while (bits-- > 0) s += (value >> bits & 1U) != 0 ? '1' : '0';
    return s;
  };
  constexpr unsigned kLengths[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64};
  unsigned code = 0;
  while (kLengths[code] != f.dlc) ++code;
  std::string bits = "0";
  if ((f.id & kExtendedBit) == 0)
    bits += text(f.id, 11) + "00101";
  else
    bits += text(f.id >> 18U & 0x7FFU, 11) + "11" + text(f.id & 0x3FFFFU, 18) + "0101";
  std::size_t slow = bits.size();
  bits += "0" + text(code, 4);
  for (std::size_t i = 0; i < f.dlc; ++i) bits += text(f.data[i], 8);
  for (std::size_t i = 4; i + 1 < bits.size(); ++i) {
    const std::string five = bits.substr(i - 4, 5);
    if (five != "00000" && five != "11111") continue;
    bits.insert(i + 1, five[0] == '0' ? "1" : "0");
    if (i < slow) ++slow;
  }
  // Stuff count and CRC in groups of four, each after a stuff bit; CRC delimiter, 2 of acknowledge, 7 of the end, 3
  // between
  const std::size_t crc = f.dlc <= 16 ? 27 : 32;
  return {static_cast<unsigned>(slow + 1 + 2 + 7 + 3), static_cast<unsigned>(bits.size() - slow + crc)};
}

TEST(BitTime, OfFdFramesIsThatOfTheFrameWrittenOut) {
  test::Random random(9);
  for (int i = 0; i < 20000; ++i) {
    Frame f{static_cast<std::uint32_t>(random()) & kMaxId, fd_length(random() % 65), {}, Format::kFdFast};
    if (random.happens(0.5)) f.id = kExtendedBit | (static_cast<std::uint32_t>(random()) & kMaxExtendedId);
    const bool runs = i % 2 == 0;
    if (i % 4 == 0) f.id &= kExtendedBit;
    for (std::size_t b = 0; b < f.dlc; ++b)
      f.data[b] = static_cast<std::uint8_t>(runs ? (random() % 2) * 0xFF : random());
    const BitCount exact = fd_bits(f), other = by_text(f);
    ASSERT_EQ(exact.slow, other.slow) << i;
    ASSERT_EQ(exact.fast, other.fast) << i;
    EXPECT_GE(exact.ns(), min_fd_bits(f.dlc, is_extended(f)).ns());
    EXPECT_LE(exact.ns(), max_fd_bits(f.dlc, is_extended(f)).ns());
    EXPECT_EQ(frame_ns(f), exact.slow * 1000 + exact.fast * 200);
    f.format = Format::kFd;
    EXPECT_EQ(fd_bits(f).fast, 0U) << "one rate";
  }
}

TEST(BitTime, OfAnFdFrameDoneByHand) {
  // Identifier 0x555: no run of five bits in 0 10101010101 00101 | 0 0001 01010101. 17 + 13 bits slow; fast 5 + 8 + 27.
  const BitCount bits = fd_bits({0x555, 1, {0x55}, Format::kFdFast});
  EXPECT_EQ(bits.slow, 30U);
  EXPECT_EQ(bits.fast, 40U);
  EXPECT_EQ(bits.ns(), 38000);
}

}  // namespace
}  // namespace ligature::can
