#pragma once
// `local:` bus: a Unix socket that keeps packet borders; several clients, as many controllers on one cable.

#include <sys/types.h>

#include <array>

#include "sim_device/file_descriptor.hpp"
#include "sim_device/hand_device.hpp"
#include "sim_device/port.hpp"

namespace ligature::sim {

class LocalPort final : public Port {
 public:
  /// Listens at path. A socket nobody listens on any more is replaced; a live one, or another kind of file, is refused.
  [[nodiscard]] static std::variant<std::unique_ptr<Port>, std::string> open(const std::string& path);
  ~LocalPort() override;  ///< removes the socket, unless somebody has put another one in its place

  void add_descriptors(std::vector<pollfd>& fds) const override;
  void receive(std::vector<Received>& frames, std::vector<int>& left) override;
  void send(const can::Frame& frame, int except_client) override;
  [[nodiscard]] int clients() const noexcept override;
  [[nodiscard]] bool charges_bit_time() const noexcept override { return false; }
  [[nodiscard]] long dropped_frames() const noexcept override { return dropped_; }

 private:
  LocalPort(std::string path, FileDescriptor listener, ino_t inode)
      : path_(std::move(path)), listener_(std::move(listener)), inode_(inode) {}
  void accept_clients();
  /// Reads one client empty; false when it is gone.
  bool read_all(std::size_t slot, std::vector<Received>& frames);

  std::string path_;
  FileDescriptor listener_;
  ino_t inode_;
  std::array<FileDescriptor, HandDevice::kMaxClients> clients_;
  long dropped_ = 0;
};

}  // namespace ligature::sim
