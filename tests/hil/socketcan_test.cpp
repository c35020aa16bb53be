// The SocketCAN back ends with the kernel's AF_CAN; needs vcan0. Runs in the guest of scripts/test-hil, as root.
#include <gtest/gtest.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstring>

#include "firmware/platform/socket_bus.hpp"
#include "sim_device/can_port.hpp"

namespace ligature {
namespace {

using platform::Receive;
const can::Frame kFrame{0x181, 3, {1, 2, 3}};

std::unique_ptr<platform::CanBus> opened(can::Network network = can::Network::kClassic) {
  return std::move(std::get<0>(platform::open_can_bus("socketcan:vcan0", network)));
}

/// Another node on the bus, which can also send frames that our own code never sends.
class Stranger {
 public:
  Stranger() : fd_(socket(PF_CAN, SOCK_RAW, CAN_RAW)) {
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = static_cast<int>(if_nametoindex("vcan0"));
    EXPECT_EQ(bind(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    constexpr int kOn = 1;
    EXPECT_EQ(setsockopt(fd_, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &kOn, sizeof kOn), 0);
  }
  ~Stranger() { close(fd_); }
  void send(canid_t id, std::uint8_t length = 8) const {
    can_frame f{};
    f.can_id = id;
    f.can_dlc = length;
    EXPECT_EQ(write(fd_, &f, sizeof f), static_cast<ssize_t>(sizeof f));
  }
  void send_fd(canid_t id, std::uint8_t length) const {
    canfd_frame f{};
    f.can_id = id;
    f.len = length;
    f.flags = CANFD_BRS;
    EXPECT_EQ(write(fd_, &f, sizeof f), static_cast<ssize_t>(sizeof f));
  }
  bool hears(canid_t id, ssize_t bytes = CAN_MTU) const {
    pollfd p{fd_, POLLIN, 0};
    canfd_frame f{};
    for (ssize_t got = 0; poll(&p, 1, 1000) == 1 && (got = read(fd_, &f, sizeof f)) > 0;)
      if (f.can_id == id && got == bytes) return true;
    return false;
  }

 private:
  int fd_;
};

void set_up(bool up) {
  const int fd = socket(PF_CAN, SOCK_RAW, CAN_RAW);
  ifreq request{};
  std::strncpy(request.ifr_name, "vcan0", IFNAMSIZ - 1);
  ASSERT_EQ(ioctl(fd, SIOCGIFFLAGS, &request), 0);
  const int flags = up ? request.ifr_flags | IFF_UP : request.ifr_flags & ~IFF_UP;
  request.ifr_flags = static_cast<short>(flags);
  ASSERT_EQ(ioctl(fd, SIOCSIFFLAGS, &request), 0);
  close(fd);
}

/// Only while the interface is down.
void set_mtu(int mtu) {
  const int fd = socket(PF_CAN, SOCK_RAW, CAN_RAW);
  ifreq request{};
  std::strncpy(request.ifr_name, "vcan0", IFNAMSIZ - 1);
  request.ifr_mtu = mtu;
  ASSERT_EQ(ioctl(fd, SIOCSIFMTU, &request), 0);
  close(fd);
}

/// Waits up to 1 s for the next frame or the loss of the bus.
Receive next(platform::CanBus& bus, can::Frame& frame) {
  pollfd p{bus.descriptor(), POLLIN, 0};
  poll(&p, 1, 1000);
  return bus.receive(frame);
}

TEST(SocketCan, CarriesFramesBothWaysAndDoesNotHearItself) {
  const auto bus = opened();
  const Stranger stranger;
  can::Frame frame;
  EXPECT_TRUE(bus->send(kFrame));
  EXPECT_TRUE(stranger.hears(0x181));
  EXPECT_EQ(bus->receive(frame), Receive::kNothing);
  stranger.send(0x182, 5);
  ASSERT_EQ(next(*bus, frame), Receive::kFrame);
  EXPECT_EQ(frame.id, 0x182U);
  EXPECT_EQ(frame.dlc, 5);
}

TEST(SocketCan, TakesRemoteFramesAndSkipsExtendedAndFdFrames) {
  const auto bus = opened();
  const Stranger stranger;
  stranger.send(0x181 | CAN_EFF_FLAG);
  stranger.send_fd(0x181, 12);
  stranger.send(0x182 | CAN_RTR_FLAG);
  can::Frame frame;
  ASSERT_EQ(next(*bus, frame), Receive::kFrame);
  EXPECT_EQ(frame.id, can::kRemoteBit | 0x182U);
}

TEST(SocketCan, CarriesFdAndExtendedFramesIfTheDrivesNeedThem) {
  const auto bus = opened(can::Network::kFd);
  const Stranger stranger;
  EXPECT_TRUE(bus->send({can::kExtendedBit | 0x8001, 12, {1, 2, 3}, can::Format::kFdFast}));
  EXPECT_TRUE(stranger.hears(0x8001 | CAN_EFF_FLAG, CANFD_MTU));
  stranger.send_fd(0x100, 24);
  can::Frame frame;
  ASSERT_EQ(next(*bus, frame), Receive::kFrame);
  EXPECT_EQ(frame, (can::Frame{0x100, 24, {}, can::Format::kFdFast}));
  stranger.send(0x400, 2);
  ASSERT_EQ(next(*bus, frame), Receive::kFrame);
  EXPECT_EQ(frame, (can::Frame{0x400, 2, {}})) << "a module may be a classic node";
}

TEST(SocketCan, AnInterfaceWithoutFdIsRefusedIfTheDrivesNeedIt) {
  set_up(false);
  set_mtu(CAN_MTU);
  set_up(true);
  const auto refused = platform::open_can_bus("socketcan:vcan0", can::Network::kFd);
  const auto* error = std::get_if<platform::OpenError>(&refused);
  EXPECT_TRUE(error != nullptr && error->text.find("carries no CAN-FD frames") != std::string::npos);
  EXPECT_TRUE(opened());
  set_up(false);
  set_mtu(CANFD_MTU);
  set_up(true);
}

TEST(SocketCan, BusOffIsALossUntilTheDriverWasRestarted) {
  const auto bus = opened();
  const Stranger stranger;
  can::Frame frame;
  stranger.send(0x181);
  stranger.send(CAN_ERR_FLAG | CAN_ERR_BUSOFF);
  stranger.send(0x182);
  EXPECT_EQ(next(*bus, frame), Receive::kFrame);
  EXPECT_EQ(next(*bus, frame), Receive::kLost);
  EXPECT_EQ(bus->receive(frame), Receive::kLost) << "what waited is dropped";
  EXPECT_FALSE(bus->send(kFrame));
  stranger.send(0x183);
  EXPECT_EQ(next(*bus, frame), Receive::kLost) << "a frame does not bring it back";
  stranger.send(CAN_ERR_FLAG | CAN_ERR_RESTARTED);
  stranger.send(0x184);
  EXPECT_EQ(next(*bus, frame), Receive::kFrame);
  EXPECT_EQ(frame.id, 0x184U);
  EXPECT_FALSE(bus->is_lost());
  EXPECT_TRUE(bus->send(kFrame));
}

TEST(SocketCan, OtherErrorFramesAreNoLoss) {
  const auto bus = opened();
  const Stranger stranger;
  stranger.send(CAN_ERR_FLAG | CAN_ERR_CRTL);
  stranger.send(0x181);
  can::Frame frame;
  EXPECT_EQ(next(*bus, frame), Receive::kFrame);
  EXPECT_FALSE(bus->is_lost());
}

TEST(SocketCan, AnInterfaceThatWasDownComesBackWithItsFirstFrame) {
  for (const bool is_sent : {false, true}) {
    const auto bus = opened();
    can::Frame frame;
    set_up(false);
    EXPECT_EQ(next(*bus, frame), Receive::kLost);
    EXPECT_TRUE(bus->is_lost());
    EXPECT_FALSE(bus->send(kFrame));
    set_up(true);
    EXPECT_EQ(bus->receive(frame), Receive::kLost) << "up is not yet somebody there";
    const Stranger stranger;
    if (is_sent) {
      EXPECT_TRUE(bus->send(kFrame));
      EXPECT_TRUE(stranger.hears(0x181));
    } else {
      stranger.send(0x701);
      EXPECT_EQ(next(*bus, frame), Receive::kFrame);
    }
    EXPECT_FALSE(bus->is_lost());
    EXPECT_TRUE(bus->send(kFrame));
  }
}

TEST(SocketCan, AnInterfaceThatIsDownCannotBeOpenedForGoodOrIsLostAtOnce) {
  set_up(false);
  auto result = platform::open_can_bus("socketcan:vcan0");
  if (auto* bus = std::get_if<std::unique_ptr<platform::CanBus>>(&result)) {
    EXPECT_FALSE((*bus)->send(kFrame));
    EXPECT_TRUE((*bus)->is_lost());
  }
  set_up(true);
}

/// What a simulated hand hears next; waits for it for 1 s.
std::vector<sim::Received> next_frames(sim::Port& port) {
  std::vector<pollfd> fds;
  port.add_descriptors(fds);
  poll(fds.data(), fds.size(), 1000);
  std::vector<sim::Received> frames;
  std::vector<int> left;
  port.receive(frames, left);
  return frames;
}

TEST(SimulatedHandOnSocketCan, HearsAndSpeaks) {
  auto made = sim::CanPort::open("vcan0", can::Network::kClassic);
  ASSERT_TRUE(std::holds_alternative<std::unique_ptr<sim::Port>>(made));
  sim::Port& port = *std::get<0>(made);
  EXPECT_FALSE(port.charges_bit_time()) << "a virtual bus takes no time of its own";
  const Stranger stranger;
  stranger.send(0x080, 0);
  const auto frames = next_frames(port);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].frame.id, 0x080U);
  port.send(kFrame, -1);
  EXPECT_TRUE(stranger.hears(0x181));
}

TEST(SimulatedHandOnSocketCan, HearsAndSpeaksFdFramesIfItsDrivesDo) {
  auto made = sim::CanPort::open("vcan0", can::Network::kFd);
  ASSERT_TRUE(std::holds_alternative<std::unique_ptr<sim::Port>>(made));
  sim::Port& port = *std::get<0>(made);
  const Stranger stranger;
  stranger.send_fd(0x8001 | CAN_EFF_FLAG, 12);
  const auto frames = next_frames(port);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].frame.id, can::kExtendedBit | 0x8001U);
  EXPECT_EQ(frames[0].frame.dlc, 12);
  port.send({0x100, 24, {}, can::Format::kFdFast}, -1);
  EXPECT_TRUE(stranger.hears(0x100, CANFD_MTU));
}

}  // namespace
}  // namespace ligature
