#include "sim_device/local_port.hpp"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "protocol/can/local_wire.hpp"

namespace ligature::sim {
namespace {

FileDescriptor make_socket() {
  return FileDescriptor(socket(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
}

/// Prepares an address for a new socket: removes a socket on which nobody listens. @return empty, or why the path is
/// taken.
std::string clear_way(const sockaddr_un& address) {
  struct stat info {};
  if (lstat(address.sun_path, &info) != 0) return {};
  if (S_ISDIR(info.st_mode)) return "is a folder, allowed a path in it that is free";
  if (!S_ISSOCK(info.st_mode)) return "is a file, allowed a path that is free or a left-over socket";
  const FileDescriptor probe = make_socket();
  if (probe.get() < 0) return std::string("cannot be tried: ") + std::strerror(errno);
  const int connected = connect(probe.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address);
  if (connected == 0 || errno != ECONNREFUSED) return "is in use by another device, allowed one device a socket";
  unlink(address.sun_path);
  return {};
}

}  // namespace

std::variant<std::unique_ptr<Port>, std::string> LocalPort::open(const std::string& path, can::Network network) {
  const auto refuse = [&](const std::string& why) { return "--bus local:" + path + ": " + why; };
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof address.sun_path) {
    return refuse("path has " + std::to_string(path.size()) + " characters, allowed 1 .. " +
                  std::to_string(sizeof address.sun_path - 1));
  }
  std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
  if (const std::string why = clear_way(address); !why.empty()) return refuse(why);

  FileDescriptor listener = make_socket();
  struct stat info {};
  if (!listener || bind(listener.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      listen(listener.get(), HandDevice::kMaxClients) != 0 || stat(path.c_str(), &info) != 0) {
    return refuse(std::string(std::strerror(errno)) + ", allowed a path in a folder that exists and can be written");
  }
  return std::unique_ptr<Port>(new LocalPort(path, std::move(listener), info.st_ino, network));
}

LocalPort::~LocalPort() {
  struct stat info {};
  if (stat(path_.c_str(), &info) == 0 && info.st_ino == inode_) unlink(path_.c_str());
}

void LocalPort::add_descriptors(std::vector<pollfd>& fds) const {
  fds.push_back({listener_.get(), POLLIN, 0});
  for (const FileDescriptor& c : clients_) {
    if (c) fds.push_back({c.get(), POLLIN, 0});
  }
}

int LocalPort::clients() const noexcept {
  return static_cast<int>(
      std::count_if(clients_.begin(), clients_.end(), [](const FileDescriptor& c) { return bool(c); }));
}

void LocalPort::accept_clients() {
  for (;;) {
    FileDescriptor client(accept4(listener_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (!client) return;
    const auto slot = std::find_if(clients_.begin(), clients_.end(), [](const FileDescriptor& c) { return !c; });
    if (slot != clients_.end()) *slot = std::move(client);  // without a free slot the connection is closed
  }
}

bool LocalPort::read_all(std::size_t slot, std::vector<Received>& frames) {
  for (;;) {
    // One byte more, to detect packets that are too long
    std::array<std::uint8_t, can::kLocalFdPacketBytes + 1> packet;
    const ssize_t n = recv(clients_[slot].get(), packet.data(), packet.size(), 0);
    if (n < 0) return errno == EAGAIN || errno == EINTR;
    if (n == 0) return false;
    const auto frame = can::from_packet({packet.data(), static_cast<std::size_t>(n)}, network_);
    if (frame) frames.push_back({*frame, static_cast<int>(slot)});  // malformed packets are ignored
  }
}

void LocalPort::receive(std::vector<Received>& frames, std::vector<int>& left) {
  accept_clients();
  for (std::size_t slot = 0; slot < clients_.size(); ++slot) {
    if (!clients_[slot] || read_all(slot, frames)) continue;
    clients_[slot].reset();
    left.push_back(static_cast<int>(slot));
  }
}

void LocalPort::send(const can::Frame& frame, int except_client) {
  const can::LocalPacket packet = can::to_packet(frame);
  for (std::size_t slot = 0; slot < clients_.size(); ++slot) {
    if (!clients_[slot] || static_cast<int>(slot) == except_client) continue;
    if (::send(clients_[slot].get(), packet.data(), packet.size(), MSG_NOSIGNAL | MSG_DONTWAIT) < 0 && errno == EAGAIN)
      ++dropped_;
  }
}

}  // namespace ligature::sim
