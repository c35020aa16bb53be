// Single rounds of the event loop with a fake port; the time is an argument, and nothing waits.

#include "sim_device/event_loop.hpp"

#include <gtest/gtest.h>

#include "protocol/can/nmt.hpp"
#include "protocol/can/sdo.hpp"
#include "tests/unit/sim_device/virtual_master.hpp"

namespace ligature::sim {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

/// Two clients: `incoming` holds frames sent by client 0, `heard` what each client receives.
class FakePort final : public Port {
 public:
  void add_descriptors(std::vector<pollfd>&) const override {}
  void receive(std::vector<Received>& frames, std::vector<int>& left) override {
    frames.insert(frames.end(), incoming.begin(), incoming.end());
    left.insert(left.end(), leaving.begin(), leaving.end());
    incoming.clear();
    leaving.clear();
  }
  void send(const can::Frame& frame, int except_client) override {
    for (int c = 0; c < 2; ++c) {
      if (c != except_client) heard[static_cast<std::size_t>(c)].push_back(frame);
    }
  }
  [[nodiscard]] int clients() const noexcept override { return 2; }
  [[nodiscard]] bool charges_bit_time() const noexcept override { return false; }
  [[nodiscard]] long dropped_frames() const noexcept override { return 0; }

  std::vector<Received> incoming;
  std::vector<int> leaving;
  std::array<std::vector<can::Frame>, 2> heard;
};

class EventLoopTest : public testing::Test {
 protected:
  void SetUp() override {
    loop.serve(milliseconds(10));  // sends the boot-up messages
    loop.serve(milliseconds(11));
    for (auto& h : port.heard) h.clear();
  }
  HandDevice device{path_of(), milliseconds(10)};
  FakePort port;
  EventLoop loop{device, port};
};

TEST_F(EventLoopTest, AnAnswerIsHeardByAllWhenItsLastBitHasPassed) {
  port.incoming = {{can::sdo_read(can::kWaist, can::od::kStatusword), 0}};
  loop.serve(milliseconds(20));
  EXPECT_TRUE(port.heard[0].empty());
  loop.serve(milliseconds(20) + microseconds(270));  // time for request and answer, at most 135 bits each
  ASSERT_EQ(port.heard[0].size(), 1U);
  EXPECT_EQ(can::decode_sdo(port.heard[0][0])->kind, can::SdoKind::kValue);
  EXPECT_EQ(port.heard[1].size(), 2U);  // the other client hears the request as well
}

TEST_F(EventLoopTest, CountsPeriodsItSleptThrough) {
  port.incoming = {{can::sync_frame(), 0}, {can::sync_frame(), 0}, {can::sync_frame(), 0}};
  loop.serve(milliseconds(20));
  EXPECT_EQ(loop.stats().stalls, 1);
  EXPECT_EQ(device.bus_stats().syncs, 3);
  EXPECT_EQ(device.bus_stats().missed_syncs, 0);
}

TEST_F(EventLoopTest, WhatALostClientHadInItsQueueIsGone) {
  port.incoming = {{can::sync_frame(), 0}, {can::sync_frame(), 0}, {can::encode_nmt(can::NmtCommand::kStart), 0}};
  port.leaving = {0};
  loop.serve(milliseconds(11) + microseconds(1));
  loop.serve(milliseconds(30));
  EXPECT_EQ(device.cia402(0).nmt_state(), can::NmtState::kPreOperational);
}

}  // namespace
}  // namespace ligature::sim
