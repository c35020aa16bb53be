#include "sim_device/can_port.hpp"

#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "protocol/can/local_wire.hpp"

namespace ligature::sim {

static_assert(sizeof(can_frame) == can::kLocalPacketBytes && sizeof(canfd_frame) == can::kLocalFdPacketBytes);

namespace {

/// Why this interface cannot carry CAN-FD frames; empty if it can.
std::string no_fd(int fd, const std::string& interface) {
  constexpr int kOn = 1;
  ifreq request{};
  interface.copy(request.ifr_name, IFNAMSIZ - 1);
  if (ioctl(fd, SIOCGIFMTU, &request) != 0) return std::strerror(errno);
  if (request.ifr_mtu < static_cast<int>(CANFD_MTU))
    return "carries no CAN-FD frames, allowed a vcan after: ip link set " + interface + " mtu 72";
  if (setsockopt(fd, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &kOn, sizeof kOn) != 0) return std::strerror(errno);
  return {};
}

}  // namespace

std::variant<std::unique_ptr<Port>, std::string> CanPort::open(const std::string& interface, can::Network network) {
  const auto refuse = [&](const std::string& why) { return "--bus socketcan:" + interface + ": " + why; };
  FileDescriptor fd(socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW));
  if (!fd) return refuse(std::string(std::strerror(errno)) + "; a kernel without AF_CAN can use local:/path/socket");
  const unsigned index = if_nametoindex(interface.c_str());
  if (index == 0) return refuse("no such interface, allowed one that `ip link show type can` or `type vcan` lists");
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(index);
  if (bind(fd.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    return refuse(std::strerror(errno));
  if (const std::string why = network == can::Network::kFd ? no_fd(fd.get(), interface) : ""; !why.empty())
    return refuse(why);
  const bool is_virtual = interface.starts_with("vcan") || interface.starts_with("vxcan");
  return std::unique_ptr<Port>(new CanPort(std::move(fd), !is_virtual, network));
}

void CanPort::receive(std::vector<Received>& frames, std::vector<int>&) {
  for (;;) {
    std::array<std::uint8_t, can::kLocalFdPacketBytes> image;
    const ssize_t n = read(socket_.get(), image.data(), image.size());
    if (n < 0) return;
    const auto frame = can::from_packet({image.data(), static_cast<std::size_t>(n)}, network_);
    if (frame) frames.push_back({*frame, 0});
  }
}

void CanPort::send(const can::Frame& frame, int except_client) {
  if (except_client == 0) return;  // a frame from the bus has already reached all its nodes
  const can::LocalPacket image = can::to_packet(frame);
  if (write(socket_.get(), image.data(), image.size()) < 0) ++dropped_;
}

}  // namespace ligature::sim
