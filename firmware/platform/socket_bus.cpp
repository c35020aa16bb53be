#include "firmware/platform/socket_bus.hpp"

#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
namespace ligature::platform {
namespace {

using Opened = std::variant<std::unique_ptr<CanBus>, OpenError>;

Opened refuse(OpenFailure kind, const std::string& url, const std::string& why) {
  return OpenError{kind, "bus '" + url + "': " + why};
}

template <class Address>
Opened connected(int fd, const std::string& url, const Address& address, bool bind_it, BusClaim claim,
                 can::Network network) {
  const auto* a = reinterpret_cast<const sockaddr*>(&address);
  if ((bind_it ? bind(fd, a, sizeof address) : connect(fd, a, sizeof address)) != 0) {
    const std::string why = std::strerror(errno);
    close(fd);
    return refuse(OpenFailure::kNotThere, url, why + (bind_it ? "" : "; remedy: start the hand that serves it"));
  }
  return std::make_unique<SocketBus>(fd, std::move(claim), network);
}

Opened open_local(const std::string& url, const std::string& path, can::Network network) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof address.sun_path) {
    return refuse(OpenFailure::kUsage, url,
                  "path has " + std::to_string(path.size()) + " characters, allowed 1 .. 107");
  }
  std::memcpy(address.sun_path, path.data(), path.size());
  struct stat found {};
  if (stat(path.c_str(), &found) != 0)
    return refuse(OpenFailure::kNotThere, url,
                  std::string(std::strerror(errno)) + "; remedy: start the hand that serves it");
  if (!S_ISSOCK(found.st_mode)) {
    return refuse(OpenFailure::kUsage, url,
                  std::string("is ") + (S_ISDIR(found.st_mode) ? "a folder" : "no socket") +
                      ", allowed the socket that ligature-device made, or will make");
  }
  // The claim uses the inode, so that two paths of one socket count as one bus.
  auto claim = BusClaim::take("local/" + std::to_string(found.st_dev) + ":" + std::to_string(found.st_ino));
  if (const auto* why = std::get_if<std::string>(&claim)) return refuse(OpenFailure::kTaken, url, *why);
  const int fd = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (fd < 0) return refuse(OpenFailure::kNotThere, url, std::strerror(errno));
  return connected(fd, url, address, false, std::get<BusClaim>(std::move(claim)), network);
}

/// Why this interface cannot carry FD frames; empty if it can.
std::string no_fd(int fd, const std::string& interface) {
  constexpr int kOn = 1;
  ifreq request{};
  interface.copy(request.ifr_name, IFNAMSIZ - 1);
  if (ioctl(fd, SIOCGIFMTU, &request) != 0) return std::strerror(errno);
  if (request.ifr_mtu < static_cast<int>(CANFD_MTU))
    return "carries no CAN-FD frames, which these drives need; remedy: ip link set " + interface +
           " down; ip link set " + interface +
           " up type can bitrate 1000000 dbitrate 5000000 fd on (a vcan: ip link set " + interface + " mtu 72)";
  if (setsockopt(fd, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &kOn, sizeof kOn) != 0) return std::strerror(errno);
  return {};
}

Opened open_socketcan(const std::string& url, const std::string& interface, can::Network network) {
  if (interface.empty() || interface.size() >= IFNAMSIZ) {
    return refuse(OpenFailure::kUsage, url, "no such name for an interface");
  }
  const int fd = socket(AF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
  if (fd < 0) return refuse(OpenFailure::kUsage, url, std::string("no CAN in this kernel: ") + std::strerror(errno));
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(if_nametoindex(interface.c_str()));
  if (address.can_ifindex == 0) {
    close(fd);
    return refuse(OpenFailure::kUsage, url, "no interface of that name, allowed one that 'ip link' lists");
  }
  const can_err_mask_t wanted = CAN_ERR_BUSOFF | CAN_ERR_RESTARTED;  // error frames that the socket shall deliver
  if (setsockopt(fd, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &wanted, sizeof wanted) != 0) {
    const std::string why = std::strerror(errno);
    close(fd);
    return refuse(OpenFailure::kUsage, url, "no error frames from this interface: " + why);
  }
  if (const std::string why = network == can::Network::kFd ? no_fd(fd, interface) : ""; !why.empty()) {
    close(fd);
    return refuse(OpenFailure::kUsage, url, why);
  }
  auto claim = BusClaim::take("can/" + interface);
  if (const auto* why = std::get_if<std::string>(&claim)) {
    close(fd);
    return refuse(OpenFailure::kTaken, url, *why);
  }
  return connected(fd, url, address, true, std::get<BusClaim>(std::move(claim)), network);
}

}  // namespace

Opened open_can_bus(const std::string& url, can::Network network) {
  const auto starts = [&](const char* scheme) { return url.rfind(scheme, 0) == 0; };
  if (starts("local:")) return open_local(url, url.substr(6), network);
  if (starts("socketcan:")) return open_socketcan(url, url.substr(10), network);
  return refuse(OpenFailure::kUsage, url, "allowed local:/path/socket or socketcan:INTERFACE");
}

SocketBus::~SocketBus() { close(fd_); }

/// Handles a socket error. A full queue is temporary; an interface that is down may come up again; any other error
/// means that the peer or interface is gone. @return always false, as the caller's result.
bool SocketBus::note(int error) noexcept {
  if (error == ENETDOWN)
    lose(Loss::kDown);
  else if (error != EAGAIN && error != EWOULDBLOCK && error != ENOBUFS && error != EINTR)
    lose(Loss::kForGood);
  return false;
}

/// Marks the bus as lost. The socket reports "interface down" before frames that are still queued. These are dropped
/// here, because the next frame received is taken as a sign that the interface is up again. After bus-off, frames are
/// skipped until the error frame that reports the restart.
void SocketBus::lose(Loss how) noexcept {
  loss_ = how;
  if (how != Loss::kDown) return;
  constexpr int kMost = 1024;  // bounds the loop; far more frames than a period brings
  std::array<std::uint8_t, can::kLocalFdPacketBytes> dropped;
  for (int i = 0; i < kMost && recv(fd_, dropped.data(), dropped.size(), MSG_DONTWAIT) > 0; ++i) {
  }
}

/// Handles an error frame of the CAN controller. @return true if it was one, false for a normal frame.
bool SocketBus::take_error_frame(std::span<const std::uint8_t> packet) noexcept {
  if (packet.size() != can::kLocalPacketBytes) return false;
  std::uint32_t id = 0;
  std::memcpy(&id, packet.data(), sizeof id);
  if ((id & CAN_ERR_FLAG) == 0) return false;
  if ((id & CAN_ERR_BUSOFF) != 0)
    lose(Loss::kBusOff);
  else if ((id & CAN_ERR_RESTARTED) != 0 && loss_ == Loss::kBusOff)
    loss_ = Loss::kNone;
  return true;
}

/// An interface that was down is tried again: drives that speak only when asked would never send the first frame.
bool SocketBus::send(const can::Frame& frame) noexcept {
  if (is_lost() && loss_ != Loss::kDown) return false;
  const can::LocalPacket packet = can::to_packet(frame);
  const ssize_t sent = ::send(fd_, packet.data(), packet.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  if (sent != static_cast<ssize_t>(packet.size())) return note(sent < 0 ? errno : EAGAIN);
  loss_ = Loss::kNone;
  return true;
}

Receive SocketBus::receive(can::Frame& frame) noexcept {
  constexpr int kMost = 64;  // bounds the frames skipped per call, so that a flooded bus cannot block the caller
  std::array<std::uint8_t, can::kLocalFdPacketBytes + 1> packet;  // one byte more, to detect packets that are too long
  for (int i = 0; i < kMost && loss_ != Loss::kForGood; ++i) {
    const ssize_t got = recv(fd_, packet.data(), packet.size(), MSG_DONTWAIT);
    if (got < 0) {
      note(errno);
      return is_lost() ? Receive::kLost : Receive::kNothing;
    }
    if (got == 0) {
      lose(Loss::kForGood);  // the peer closed the connection
      break;
    }
    const auto bytes = std::span(packet).first(static_cast<std::size_t>(got));
    if (take_error_frame(bytes)) {
      if (is_lost()) return Receive::kLost;
      continue;
    }
    const auto decoded = can::from_packet(bytes, network_);
    if (!decoded || loss_ == Loss::kBusOff) continue;  // frames of another network are ignored
    loss_ = Loss::kNone;
    frame = *decoded;
    return Receive::kFrame;
  }
  return is_lost() ? Receive::kLost : Receive::kNothing;
}

}  // namespace ligature::platform
