#pragma once
// `local:` bus: a packet-preserving Unix socket (SOCK_SEQPACKET); several clients act as several controllers on one
// bus.

#include <sys/types.h>

#include <array>

#include "sim_device/file_descriptor.hpp"
#include "sim_device/hand_device.hpp"
#include "sim_device/port.hpp"

namespace ligature::sim {

class LocalPort final : public Port {
 public:
  /// Listens at path. Replaces a socket on which nobody listens; refuses one in use, and any other kind of file.
  [[nodiscard]] static std::variant<std::unique_ptr<Port>, std::string> open(
      const std::string& path, can::Network network = can::Network::kClassic);
  ~LocalPort() override;  ///< removes the socket file, unless it has been replaced meanwhile

  void add_descriptors(std::vector<pollfd>& fds) const override;
  void receive(std::vector<Received>& frames, std::vector<int>& left) override;
  void send(const can::Frame& frame, int except_client) override;
  [[nodiscard]] int clients() const noexcept override;
  [[nodiscard]] bool charges_bit_time() const noexcept override { return false; }
  [[nodiscard]] long dropped_frames() const noexcept override { return dropped_; }

 private:
  LocalPort(std::string path, FileDescriptor listener, ino_t inode, can::Network network)
      : path_(std::move(path)), listener_(std::move(listener)), inode_(inode), network_(network) {}
  void accept_clients();
  /// Reads everything from one client; false if it has disconnected.
  bool read_all(std::size_t slot, std::vector<Received>& frames);

  std::string path_;
  FileDescriptor listener_;
  ino_t inode_;
  can::Network network_;
  std::array<FileDescriptor, HandDevice::kMaxClients> clients_;
  long dropped_ = 0;
};

}  // namespace ligature::sim
