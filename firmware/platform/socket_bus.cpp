#include "firmware/platform/socket_bus.hpp"

#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "protocol/can/local_wire.hpp"

namespace ligature::platform {
namespace {

using Opened = std::variant<std::unique_ptr<CanBus>, OpenError>;

Opened refuse(OpenFailure kind, const std::string& url, const std::string& why) {
  return OpenError{kind, "bus '" + url + "': " + why};
}

template <class Address>
Opened connected(int fd, const std::string& url, const Address& address, bool bind_it) {
  const auto* a = reinterpret_cast<const sockaddr*>(&address);
  if ((bind_it ? bind(fd, a, sizeof address) : connect(fd, a, sizeof address)) != 0) {
    const std::string why = std::strerror(errno);
    close(fd);
    return refuse(OpenFailure::kNotThere, url, why);
  }
  return std::make_unique<SocketBus>(fd);
}

Opened open_local(const std::string& url, const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof address.sun_path) {
    return refuse(OpenFailure::kUsage, url,
                  "path has " + std::to_string(path.size()) + " characters, allowed 1 .. 107");
  }
  std::memcpy(address.sun_path, path.data(), path.size());
  struct stat found {};
  if (stat(path.c_str(), &found) == 0 && !S_ISSOCK(found.st_mode)) {
    return refuse(OpenFailure::kUsage, url,
                  std::string("is ") + (S_ISDIR(found.st_mode) ? "a folder" : "no socket") +
                      ", allowed the socket that ligature-device made, or will make");
  }
  const int fd = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (fd < 0) return refuse(OpenFailure::kNotThere, url, std::strerror(errno));
  return connected(fd, url, address, false);
}

Opened open_socketcan(const std::string& url, const std::string& interface) {
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
  return connected(fd, url, address, true);
}

}  // namespace

Opened open_can_bus(const std::string& url) {
  const auto starts = [&](const char* scheme) { return url.rfind(scheme, 0) == 0; };
  if (starts("local:")) return open_local(url, url.substr(6));
  if (starts("socketcan:")) return open_socketcan(url, url.substr(10));
  return refuse(OpenFailure::kUsage, url, "allowed local:/path/socket or socketcan:INTERFACE");
}

SocketBus::~SocketBus() { close(fd_); }

/// @return false always, for use as a result. Full queues pass; everything else means that the peer or interface is
/// gone.
bool SocketBus::note(int error) noexcept {
  if (error != EAGAIN && error != EWOULDBLOCK && error != ENOBUFS && error != EINTR) lost_ = true;
  return false;
}

bool SocketBus::send(const can::Frame& frame) noexcept {
  if (lost_) return false;
  const can::LocalPacket packet = can::to_packet(frame);
  const ssize_t sent = ::send(fd_, packet.data(), packet.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  return sent == static_cast<ssize_t>(packet.size()) || note(sent < 0 ? errno : EAGAIN);
}

Receive SocketBus::receive(can::Frame& frame) noexcept {
  can::LocalPacket packet;
  while (!lost_) {
    const ssize_t got = recv(fd_, packet.data(), packet.size(), MSG_DONTWAIT);
    if (got < 0) {
      note(errno);
      return lost_ ? Receive::kLost : Receive::kNothing;
    }
    if (got == 0) {
      lost_ = true;  // the peer closed: killed, ended, or refused us
      break;
    }
    if (const auto decoded = can::from_packet({packet.data(), static_cast<std::size_t>(got)})) {
      frame = *decoded;
      return Receive::kFrame;
    }  // an error or extended frame: none of ours
  }
  return Receive::kLost;
}

}  // namespace ligature::platform
