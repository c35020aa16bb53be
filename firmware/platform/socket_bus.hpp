#pragma once
// The two back ends. Both are packet sockets that carry 16-byte frame images, so one class serves them.

#include <memory>
#include <string>
#include <variant>

#include "firmware/platform/can_bus.hpp"

namespace ligature::platform {

class SocketBus final : public CanBus {
 public:
  /// Owns the descriptor, which must be non-blocking.
  explicit SocketBus(int descriptor) noexcept : fd_(descriptor) {}
  ~SocketBus() override;
  SocketBus(const SocketBus&) = delete;
  SocketBus& operator=(const SocketBus&) = delete;

  bool send(const can::Frame& frame) noexcept override;
  Receive receive(can::Frame& frame) noexcept override;
  [[nodiscard]] bool is_lost() const noexcept override { return lost_; }
  [[nodiscard]] int descriptor() const noexcept override { return fd_; }

 private:
  bool note(int error) noexcept;

  int fd_;
  bool lost_ = false;
};

enum class OpenFailure : std::uint8_t {
  kUsage,     ///< the URL cannot be meant: no waiting helps
  kNotThere,  ///< nobody listens yet, or the interface is down: may be tried again
};
struct OpenError {
  OpenFailure kind;
  std::string text;  ///< one line
};

/// `local:/path/socket` (the simulated hand listens there) or `socketcan:can0`.
[[nodiscard]] std::variant<std::unique_ptr<CanBus>, OpenError> open_can_bus(const std::string& url);

}  // namespace ligature::platform
