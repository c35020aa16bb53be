// SocketBus, the CAN bus on a socket, here on a pair of Unix sockets; `local:` buses between processes use the same
// kind.
#include "firmware/platform/socket_bus.hpp"

#include <gtest/gtest.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <utility>

#include "firmware/platform/bus_wait.hpp"
#include "firmware/platform/moteus_link.hpp"
#include "ligature_source_dir.hpp"
#include "protocol/can/local_wire.hpp"
#include "protocol/device/device_file.hpp"

namespace {

int send_error = 0, recv_error = 0;  // errno with which send and recv fail (recv once); 0: none

}  // namespace

// Replacements for libc's socket calls, so that a plain socket can return the errors of a CAN interface.
extern "C" ssize_t send(int fd, const void* bytes, std::size_t count, int flags) {
  if (send_error != 0) return errno = send_error, -1;
  return sendto(fd, bytes, count, flags, nullptr, 0);
}
extern "C" ssize_t recv(int fd, void* bytes, std::size_t count, int flags) {
  if (recv_error != 0) return errno = std::exchange(recv_error, 0), -1;
  return recvfrom(fd, bytes, count, flags, nullptr, nullptr);
}

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

TEST_F(SocketBusTest, CarriesFdFramesIfTheDrivesNeedThem) {
  const can::Frame fd{can::kExtendedBit | 0x8001, 12, {1, 2, 3}, can::Format::kFdFast};
  const auto packet = can::to_packet(fd);
  ASSERT_EQ(::send(peer, packet.data(), packet.size(), 0), 72);
  can::Frame back;
  EXPECT_EQ(bus->receive(back), Receive::kNothing) << "a bus for classic drives";
  int pair[2];
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK, 0, pair), 0);
  SocketBus fast(pair[0], {}, can::Network::kFd);
  ASSERT_EQ(::send(pair[1], packet.data(), packet.size(), 0), 72);
  EXPECT_EQ(fast.receive(back), Receive::kFrame);
  EXPECT_EQ(back, fd);
  EXPECT_TRUE(fast.send(fd));
  can::LocalPacket sent(can::kLocalFdPacketBytes);
  EXPECT_EQ(recv(pair[1], sent.data(), sent.size(), 0), 72);
  EXPECT_EQ(can::from_packet(sent, can::Network::kFd), fd);
  close(pair[1]);
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

/// Reading must be bounded: otherwise the period would not end while a peer sends as fast as it is read.
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

/// An error frame as a CAN interface's driver sends it.
can::LocalPacket told_by_driver(std::uint32_t what) {
  can::LocalPacket packet = can::to_packet({0, 8, {}});
  const std::uint32_t id = CAN_ERR_FLAG | what;
  std::memcpy(packet.data(), &id, sizeof id);
  return packet;
}

class BusOff : public SocketBusTest {
 protected:
  void put(const can::LocalPacket& packet) {
    ASSERT_EQ(::send(peer, packet.data(), packet.size(), 0), static_cast<ssize_t>(packet.size()));
  }
  void put(const can::Frame& frame) { put(can::to_packet(frame)); }
  Receive receive() { return bus->receive(last); }
  can::Frame last;
};

TEST_F(BusOff, IsALossUntilTheDriverTellsOfARestart) {
  put(told_by_driver(CAN_ERR_BUSOFF));
  EXPECT_EQ(receive(), Receive::kLost);
  EXPECT_TRUE(bus->is_lost());
  EXPECT_FALSE(bus->send(kFrame));
  for (int i = 0; i < 3; ++i) {  // frames are no sign of recovery: a controller in bus-off receives nothing
    put(kFrame);
    EXPECT_EQ(receive(), Receive::kLost);
    EXPECT_TRUE(bus->is_lost());
  }
  put(told_by_driver(CAN_ERR_RESTARTED));
  put(kFrame);
  EXPECT_EQ(receive(), Receive::kFrame);
  EXPECT_FALSE(bus->is_lost());
  EXPECT_TRUE(bus->send(kFrame));
}

TEST_F(BusOff, WhatWasQueuedBeforeItIsNoSignOfLife) {
  put(told_by_driver(CAN_ERR_BUSOFF));
  for (int i = 0; i < 5; ++i) put(kFrame);  // received before the bus-off, read after it
  EXPECT_EQ(receive(), Receive::kLost);
  put(told_by_driver(CAN_ERR_RESTARTED));
  EXPECT_EQ(receive(), Receive::kNothing) << "frames of before the loss came through";
}

TEST_F(BusOff, ARestartThatWasToldWithItIsHeard) {  // a loop that was delayed reads both at once
  put(told_by_driver(CAN_ERR_BUSOFF));
  put(kFrame);
  put(told_by_driver(CAN_ERR_RESTARTED));
  EXPECT_EQ(receive(), Receive::kLost) << "the loss itself is told first";
  EXPECT_EQ(receive(), Receive::kNothing);
  EXPECT_FALSE(bus->is_lost());
}

TEST_F(BusOff, OtherNewsOfTheDriverIsNone) {
  put(told_by_driver(CAN_ERR_RESTARTED));
  EXPECT_EQ(receive(), Receive::kNothing);
  EXPECT_FALSE(bus->is_lost());
}

class Interface : public BusOff {
 protected:
  void TearDown() override {
    send_error = recv_error = 0;
    BusOff::TearDown();
  }
};

TEST_F(Interface, AFullQueueOfItsIsNoLoss) {
  send_error = ENOBUFS;
  EXPECT_FALSE(bus->send(kFrame));
  EXPECT_FALSE(bus->is_lost());
  send_error = 0;
  EXPECT_TRUE(bus->send(kFrame));
}

TEST_F(Interface, ThatIsDownIsLostUntilItsFirstFrame) {
  for (int* const error : {&recv_error, &send_error}) {
    *error = ENETDOWN;
    EXPECT_TRUE(error == &recv_error ? receive() == Receive::kLost : !bus->send(kFrame));
    EXPECT_TRUE(bus->is_lost());
    *error = 0;
    put(told_by_driver(CAN_ERR_RESTARTED));  // ends a bus-off, which was not the cause of this loss
    EXPECT_EQ(receive(), Receive::kLost) << "no frame yet";
    put(kFrame);
    EXPECT_EQ(receive(), Receive::kFrame);
    EXPECT_FALSE(bus->is_lost());
  }
}

/// Drives that speak only when asked send no first frame. So the controller's own frames must try the interface.
TEST_F(Interface, ThatIsDownIsTriedByEachFrameSent) {
  recv_error = send_error = ENETDOWN;
  EXPECT_EQ(receive(), Receive::kLost);
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(bus->send(kFrame));
  EXPECT_TRUE(bus->is_lost());
  char packet[16];
  EXPECT_LT(recv(peer, packet, sizeof packet, MSG_DONTWAIT), 0);
  send_error = ENOBUFS;
  EXPECT_FALSE(bus->send(kFrame));
  EXPECT_TRUE(bus->is_lost()) << "a full queue says nothing of the interface";
  send_error = 0;
  EXPECT_TRUE(bus->send(kFrame));
  EXPECT_FALSE(bus->is_lost());
  EXPECT_EQ(recv(peer, packet, sizeof packet, MSG_DONTWAIT), 16);
}

/// moteus drives must get their stops after the interface was down, although they have said nothing since.
TEST_F(Interface, SilentDrivesGetTheirStopsWhenItIsUpAgain) {
  const auto device =
      std::get<device::Device>(device::load_device(std::string(LIGATURE_SOURCE_DIR) + "/scenes/devices/moteus.toml"));
  MoteusLink link(*bus, device, 20);
  recv_error = send_error = ENETDOWN;
  for (int k = 0; k < 3; ++k) {
    link.request();
    link.drain();
    EXPECT_TRUE(link.reading().bus_lost);
    link.write({{}, rt::DriveRequest::kHold});
  }
  send_error = 0;
  link.write({{}, rt::DriveRequest::kHold});
  for (unsigned node = 1; node <= 3; ++node) {
    can::LocalPacket packet(can::kLocalFdPacketBytes);
    ASSERT_EQ(recv(peer, packet.data(), packet.size(), MSG_DONTWAIT), 72);
    EXPECT_EQ(can::from_packet(packet, can::Network::kFd), moteus::stop(node));
  }
}

/// The kernel reports the error first, and then delivers the frames that it had queued.
TEST_F(Interface, WhatWasQueuedBeforeItWentDownIsNoSignOfLife) {
  for (int* const error : {&recv_error, &send_error}) {
    for (int i = 0; i < 40; ++i) put(kFrame);
    *error = ENETDOWN;
    EXPECT_TRUE(error == &recv_error ? receive() == Receive::kLost : !bus->send(kFrame));
    *error = 0;
    EXPECT_EQ(receive(), Receive::kLost) << "a frame of before the loss came through";
    put(kFrame);
    EXPECT_EQ(receive(), Receive::kFrame);
  }
}

TEST_F(Interface, ThatIsGoneStaysGone) {
  send_error = ENODEV;
  EXPECT_FALSE(bus->send(kFrame));
  send_error = 0;
  put(kFrame);
  EXPECT_EQ(receive(), Receive::kLost);
  EXPECT_TRUE(bus->is_lost());
}

/// Waiting must end with the first frame on either hand's bus; the deadline is never reached here.
TEST_F(SocketBusTest, WaitingEndsWithTheFirstFrameOfEitherBus) {
  int pair[2];
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK, 0, pair), 0);
  SocketBus quiet(pair[0]);
  const auto packet = can::to_packet(kFrame);
  ASSERT_EQ(::send(peer, packet.data(), packet.size(), 0), 16);
  for (const bool left : {true, false}) {
    PollWait wait(left ? *bus : quiet, left ? quiet : *bus);
    const Nanoseconds deadline = wait.now() + std::chrono::seconds(20);
    EXPECT_TRUE(wait.wait(deadline));
    EXPECT_LT(wait.now(), deadline) << (left ? "left" : "right") << " is not waited for";
  }
  close(pair[1]);
}

/// A closed socket is always readable, so waiting for it would never sleep.
TEST_F(BusOff, ALostBusIsNotWaitedFor) {
  close(peer);
  peer = -1;
  EXPECT_EQ(receive(), Receive::kLost);
  PollWait wait(*bus, *bus);
  const Nanoseconds deadline = wait.now() + std::chrono::milliseconds(50);
  (void)wait.wait(deadline);
  EXPECT_GE(wait.now(), deadline) << "it came back at once";
  EXPECT_FALSE(wait.wait(deadline));
}

}  // namespace
}  // namespace ligature::platform
