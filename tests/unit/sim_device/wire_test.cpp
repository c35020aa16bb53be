#include "sim_device/wire.hpp"

#include <gtest/gtest.h>

#include "protocol/can/codec.hpp"
#include "protocol/can/nmt.hpp"

namespace ligature::sim {
namespace {

using std::chrono::microseconds;

can::Frame frame(std::uint32_t id, std::uint8_t dlc = 0) { return {id, dlc, {}}; }

TEST(Wire, AFrameTakesItsBitsAtOneMegabit) {
  Wire wire;
  const can::Frame f = can::encode(can::kWaist, can::Tpdo1{0x1237, 1000, 5, 0});
  wire.submit(f, 0, microseconds(10));
  const auto sent = wire.advance(microseconds(10));
  ASSERT_TRUE(sent);
  EXPECT_EQ(sent->start, microseconds(10));
  EXPECT_EQ(sent->end - sent->start, microseconds(can::frame_bits(f) - 3));
  EXPECT_EQ(wire.stats().busy, microseconds(can::frame_bits(f)));
}

TEST(Wire, TheLowestIdentifierWinsAmongThoseThatWait) {
  Wire wire;
  wire.submit(frame(0x300), 0, microseconds(0));  // starts at once because the bus is idle
  wire.submit(frame(0x203), 1, microseconds(5));
  wire.submit(frame(0x183), 2, microseconds(20));
  wire.submit(frame(0x081), 3, microseconds(30));
  std::vector<std::uint32_t> order;
  Time end{};
  while (const auto sent = wire.advance(microseconds(1000))) {
    EXPECT_TRUE(order.empty() || sent->start == end + microseconds(3));  // back to back, with interframe space
    end = sent->end;
    order.push_back(sent->frame.id);
  }
  EXPECT_EQ(order, (std::vector<std::uint32_t>{0x300, 0x081, 0x183, 0x203}));
}

TEST(Wire, AFrameThatComesLaterCannotOvertakeOneThatHasStarted) {
  Wire wire;
  wire.submit(frame(0x400), 0, microseconds(0));
  wire.submit(frame(0x100), 1, microseconds(1));
  EXPECT_EQ(wire.advance(microseconds(100))->frame.id, 0x400U);
}

TEST(Wire, ASenderKeepsItsOwnOrder) {
  Wire wire;
  wire.submit(frame(0x203), 0, microseconds(0));
  wire.submit(frame(0x080), 0, microseconds(0));  // a higher-priority identifier, but second in its controller's queue
  EXPECT_EQ(wire.advance(microseconds(1000))->frame.id, 0x203U);
  EXPECT_EQ(wire.advance(microseconds(1000))->frame.id, 0x080U);
}

TEST(Wire, DoesNotSendBeforeItsTime) {
  Wire wire;
  wire.submit(frame(0x100), 0, microseconds(50));
  EXPECT_FALSE(wire.advance(microseconds(49)));
  EXPECT_EQ(wire.quiet_at(), microseconds(50 + can::frame_bits(frame(0x100))));
  EXPECT_TRUE(wire.advance(microseconds(50)));
  EXPECT_EQ(wire.quiet_at(), kNever);
}

TEST(Wire, OneTickLoadsTheBusBy62To75Percent) {
  Wire wire;
  wire.submit(can::sync_frame(), 3, Time(0));
  for (int n = 0; n < 3; ++n) {
    const can::NodeId node = can::profile::kJointNodes[static_cast<std::size_t>(n)];
    wire.submit(can::encode(node, can::Tpdo1{0x1237, -4711 * n, 17, 3}), n, Time(0));
    wire.submit(can::encode(node, can::Rpdo1{15, static_cast<std::int16_t>(-300 * n)}), 3, Time(0));
  }
  while (wire.advance(microseconds(1000))) {
  }
  EXPECT_GE(wire.stats().busy, microseconds(617));
  EXPECT_LE(wire.stats().busy, microseconds(745));
}

TEST(Wire, ABusThatTakesItsOwnTimeIsNotChargedTwice) {
  Wire wire(false);
  wire.submit(frame(0x100, 8), 0, microseconds(7));
  EXPECT_EQ(wire.advance(microseconds(7))->end, microseconds(7));
}

}  // namespace
}  // namespace ligature::sim
