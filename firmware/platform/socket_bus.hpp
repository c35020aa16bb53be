#pragma once
// The two back ends. Both are packet sockets that carry 16-byte frame images, so one class serves them.

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <variant>

#include "firmware/platform/bus_claim.hpp"
#include "firmware/platform/can_bus.hpp"
#include "protocol/can/local_wire.hpp"

namespace ligature::platform {

/// A `local:` bus that is lost stays lost: its other end is gone. A CAN interface may come back: after being down with
/// its first frame, after bus-off when its driver tells that it was restarted. What was queued before that is
/// dropped. Whether force may come back is not asked here: the loss was a fault, and faults are latched.
class SocketBus final : public CanBus {
 public:
  /// Owns the descriptor, which must be non-blocking.
  explicit SocketBus(int descriptor, BusClaim claim = {}) noexcept : fd_(descriptor), claim_(std::move(claim)) {}
  ~SocketBus() override;
  SocketBus(const SocketBus&) = delete;
  SocketBus& operator=(const SocketBus&) = delete;

  bool send(const can::Frame& frame) noexcept override;
  Receive receive(can::Frame& frame) noexcept override;
  [[nodiscard]] bool is_lost() const noexcept override { return loss_ != Loss::kNone; }
  [[nodiscard]] int descriptor() const noexcept override { return fd_; }

 private:
  enum class Loss : std::uint8_t { kNone, kBusOff, kDown, kForGood };

  bool note(int error) noexcept;
  void lose(Loss how) noexcept;
  bool take_error_frame(const can::LocalPacket& packet) noexcept;

  int fd_;
  BusClaim claim_;
  Loss loss_ = Loss::kNone;
};

enum class OpenFailure : std::uint8_t {
  kUsage,     ///< the URL cannot be meant: no waiting helps
  kNotThere,  ///< nobody listens yet, or the interface is down: may be tried again
  kTaken,     ///< another controller on this machine has it
};
struct OpenError {
  OpenFailure kind;
  std::string text;  ///< one line
};

/// `local:/path/socket` (the simulated hand listens there) or `socketcan:can0`; held alone until it is closed.
[[nodiscard]] std::variant<std::unique_ptr<CanBus>, OpenError> open_can_bus(const std::string& url);

}  // namespace ligature::platform
