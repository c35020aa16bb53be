// The socket back end over a socket pair of the kind that `local:` uses.
#include "firmware/platform/socket_bus.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include "protocol/can/local_wire.hpp"

namespace ligature::platform {
namespace {

class SocketBusTest : public ::testing::Test {
 protected:
  void SetUp() override {
    int pair[2];
    ASSERT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK, 0, pair), 0);
    bus = std::make_unique<SocketBus>(pair[0]);
    peer = pair[1];
  }
  void TearDown() override {
    if (peer >= 0) close(peer);
  }
  std::unique_ptr<SocketBus> bus;
  int peer = -1;
};

const can::Frame kFrame{0x181, 3, {1, 2, 3}};

TEST_F(SocketBusTest, CarriesFramesBothWays) {
  EXPECT_TRUE(bus->send(kFrame));
  can::LocalPacket packet;
  ASSERT_EQ(recv(peer, packet.data(), packet.size(), 0), 16);
  EXPECT_EQ(can::from_packet(packet), kFrame);
  ASSERT_EQ(::send(peer, packet.data(), packet.size(), 0), 16);
  can::Frame back;
  EXPECT_EQ(bus->receive(back), Receive::kFrame);
  EXPECT_EQ(back, kFrame);
  EXPECT_EQ(bus->receive(back), Receive::kNothing);
}

TEST_F(SocketBusTest, SeesAClosedPeerAtOnce) {
  close(peer);
  peer = -1;
  can::Frame frame;
  EXPECT_EQ(bus->receive(frame), Receive::kLost);
  EXPECT_TRUE(bus->is_lost());
  EXPECT_FALSE(bus->send(kFrame));
}

TEST_F(SocketBusTest, AFullQueueDropsTheFrameAndLosesNothingElse) {
  int sent = 0;
  while (bus->send(kFrame) && sent < 1'000'000) ++sent;
  EXPECT_GT(sent, 0);
  EXPECT_LT(sent, 1'000'000);
  EXPECT_FALSE(bus->is_lost());
}

TEST_F(SocketBusTest, SkipsWhatIsNoFrame) {
  const char nonsense[5] = "what";
  ASSERT_EQ(::send(peer, nonsense, sizeof nonsense, 0), 5);
  const auto packet = can::to_packet(kFrame);
  ASSERT_EQ(::send(peer, packet.data(), packet.size(), 0), 16);
  can::Frame frame;
  EXPECT_EQ(bus->receive(frame), Receive::kFrame);
  EXPECT_EQ(frame, kFrame);
}

/// A peer that sends as fast as it is read would keep a period from ending.
TEST_F(SocketBusTest, AFloodOfWhatIsNoFrameHoldsNobodyUp) {
  const char nonsense[5] = "what";
  int sent = 0;
  while (::send(peer, nonsense, sizeof nonsense, MSG_DONTWAIT) == 5) ++sent;
  ASSERT_GT(sent, 64);
  can::Frame frame;
  EXPECT_EQ(bus->receive(frame), Receive::kNothing);
  char next[16];
  EXPECT_EQ(recv(bus->descriptor(), next, sizeof next, MSG_DONTWAIT), 5) << "all of it was read in one call";
  EXPECT_FALSE(bus->is_lost());
}

OpenFailure failure_of(const std::string& url) {
  auto opened = open_can_bus(url);
  const auto* error = std::get_if<OpenError>(&opened);
  EXPECT_NE(error, nullptr) << url;
  if (error == nullptr) return OpenFailure::kUsage;
  EXPECT_NE(error->text.find(url), std::string::npos);
  return error->kind;
}

TEST(OpenCanBus, TellsBadUsageFromWhatIsNotThereYet) {
  EXPECT_EQ(failure_of("ethercat:0"), OpenFailure::kUsage);
  EXPECT_EQ(failure_of("local:"), OpenFailure::kUsage);
  EXPECT_EQ(failure_of("local:/" + std::string(200, 'x')), OpenFailure::kUsage);
  EXPECT_EQ(failure_of("socketcan:a-name-that-is-far-too-long"), OpenFailure::kUsage);
  EXPECT_EQ(failure_of("local:/nowhere/at/all"), OpenFailure::kNotThere);
  EXPECT_EQ(failure_of("socketcan:nosuchcan9"), OpenFailure::kUsage);
  EXPECT_EQ(failure_of("local:/tmp"), OpenFailure::kUsage);  // a folder, and a file, will never be a socket
  EXPECT_EQ(failure_of("local:/proc/self/stat"), OpenFailure::kUsage);
}

}  // namespace
}  // namespace ligature::platform
