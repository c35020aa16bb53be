#include "firmware/platform/bus_claim.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>

namespace ligature::platform {
namespace {

struct AbstractName {
  sockaddr_un address{};
  socklen_t size = 0;
};

/// Address in the abstract namespace (leading zero byte): owned by the kernel, with no file.
AbstractName abstract(const std::string& name) {
  AbstractName a;
  a.address.sun_family = AF_UNIX;
  const std::size_t bytes = std::min(name.size(), sizeof a.address.sun_path - 1);
  std::memcpy(a.address.sun_path + 1, name.data(), bytes);
  a.size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + bytes);
  return a;
}

/// Process that holds the name; 0 if unknown.
pid_t holder_of(const AbstractName& name) {
  const int fd = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  ucred who{};
  socklen_t size = sizeof who;
  const bool known = fd >= 0 && connect(fd, reinterpret_cast<const sockaddr*>(&name.address), name.size) == 0 &&
                     getsockopt(fd, SOL_SOCKET, SO_PEERCRED, &who, &size) == 0;
  if (fd >= 0) close(fd);
  return known ? who.pid : 0;
}

}  // namespace

std::variant<BusClaim, std::string> BusClaim::take(const std::string& name) {
  const AbstractName at = abstract("ligature-firmware/" + name);
  BusClaim claim(socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0));
  if (claim.fd_ < 0) return std::string(std::strerror(errno));
  constexpr int kCallers = 16;  // backlog for processes that ask who holds it
  if (bind(claim.fd_, reinterpret_cast<const sockaddr*>(&at.address), at.size) == 0 && listen(claim.fd_, kCallers) == 0)
    return claim;
  if (errno != EADDRINUSE) return std::string(std::strerror(errno));
  const pid_t holder = holder_of(at);
  return "another controller on this machine has it" +
         (holder > 0 ? " (process " + std::to_string(holder) + ")" : std::string()) +
         "; remedy: end that one first, or give this one a bus of its own";
}

BusClaim::~BusClaim() {
  if (fd_ >= 0) close(fd_);
}

}  // namespace ligature::platform
