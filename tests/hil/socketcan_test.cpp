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

std::unique_ptr<platform::CanBus> opened() { return std::move(std::get<0>(platform::open_can_bus("socketcan:vcan0"))); }

/// Another node on the bus, which can also send frames that our own code never sends.
class Stranger {
 public:
  Stranger() : fd_(socket(PF_CAN, SOCK_RAW, CAN_RAW)) {
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = static_cast<int>(if_nametoindex("vcan0"));
    EXPECT_EQ(bind(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  }
  ~Stranger() { close(fd_); }
  void send(canid_t id, std::uint8_t length = 8) const {
    can_frame f{};
    f.can_id = id;
    f.can_dlc = length;
    EXPECT_EQ(write(fd_, &f, sizeof f), static_cast<ssize_t>(sizeof f));
  }
  bool hears(canid_t id) const {
    pollfd p{fd_, POLLIN, 0};
    can_frame f{};
    while (poll(&p, 1, 1000) == 1 && read(fd_, &f, sizeof f) > 0)
      if (f.can_id == id) return true;
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

/// Waits up to 1 s for the next frame or the loss of the bus.
Receive next(platform::CanBus& bus, can::Frame& frame) {
  pollfd p{bus.descriptor(), POLLIN, 0};
  poll(&p, 1, 1000);
  return bus.receive(frame);
}

TEST(SocketCan, CarriesFramesBothWaysAndDoesNotHearItself) {
  const auto one = opened(), other = opened();
  can::Frame frame;
  EXPECT_TRUE(one->send(kFrame));
  EXPECT_EQ(next(*other, frame), Receive::kFrame);
  EXPECT_EQ(frame, kFrame);
  EXPECT_EQ(one->receive(frame), Receive::kNothing);
  EXPECT_TRUE(other->send(kFrame));
  EXPECT_EQ(next(*one, frame), Receive::kFrame);
}

TEST(SocketCan, SkipsExtendedAndRemoteFrames) {
  const auto bus = opened();
  const Stranger stranger;
  stranger.send(0x181 | CAN_EFF_FLAG);
  stranger.send(0x181 | CAN_RTR_FLAG);
  stranger.send(0x182, 5);
  can::Frame frame;
  ASSERT_EQ(next(*bus, frame), Receive::kFrame);
  EXPECT_EQ(frame.id, 0x182U);
  EXPECT_EQ(frame.dlc, 5);
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
  const auto bus = opened();
  can::Frame frame;
  set_up(false);
  EXPECT_EQ(next(*bus, frame), Receive::kLost);
  EXPECT_TRUE(bus->is_lost());
  EXPECT_FALSE(bus->send(kFrame));
  set_up(true);
  EXPECT_EQ(bus->receive(frame), Receive::kLost) << "up is not yet somebody there";
  const Stranger stranger;
  stranger.send(0x701);
  EXPECT_EQ(next(*bus, frame), Receive::kFrame);
  EXPECT_FALSE(bus->is_lost());
  EXPECT_TRUE(bus->send(kFrame));
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

TEST(SimulatedHandOnSocketCan, HearsAndSpeaks) {
  auto made = sim::CanPort::open("vcan0");
  ASSERT_TRUE(std::holds_alternative<std::unique_ptr<sim::Port>>(made));
  sim::Port& port = *std::get<0>(made);
  EXPECT_FALSE(port.charges_bit_time()) << "a virtual bus takes no time of its own";
  const Stranger stranger;
  stranger.send(0x080, 0);
  std::vector<pollfd> fds;
  port.add_descriptors(fds);
  ASSERT_EQ(poll(fds.data(), fds.size(), 1000), 1);
  std::vector<sim::Received> frames;
  std::vector<int> left;
  port.receive(frames, left);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].frame.id, 0x080U);
  port.send(kFrame, -1);
  EXPECT_TRUE(stranger.hears(0x181));
}

}  // namespace
}  // namespace ligature
