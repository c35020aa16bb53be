#pragma once
// `socketcan:` bus: one raw CAN socket. The bus counts as a single client, because CAN frames do not name their sender.

#include "sim_device/file_descriptor.hpp"
#include "sim_device/port.hpp"

namespace ligature::sim {

class CanPort final : public Port {
 public:
  [[nodiscard]] static std::variant<std::unique_ptr<Port>, std::string> open(const std::string& interface,
                                                                             can::Network network);

  void add_descriptors(std::vector<pollfd>& fds) const override { fds.push_back({socket_.get(), POLLIN, 0}); }
  void receive(std::vector<Received>& frames, std::vector<int>& left) override;
  void send(const can::Frame& frame, int except_client) override;
  [[nodiscard]] int clients() const noexcept override { return 1; }
  [[nodiscard]] bool charges_bit_time() const noexcept override { return is_hardware_; }
  [[nodiscard]] long dropped_frames() const noexcept override { return dropped_; }

 private:
  CanPort(FileDescriptor socket, bool is_hardware, can::Network network)
      : socket_(std::move(socket)), is_hardware_(is_hardware), network_(network) {}

  FileDescriptor socket_;
  bool is_hardware_;
  can::Network network_;
  long dropped_ = 0;
};

}  // namespace ligature::sim
