#pragma once
// CAN bus over a socket: a Unix socket to a simulated hand, or SocketCAN. Both carry the same frame images in packets,
// so one class serves both.

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <variant>

#include "firmware/platform/bus_claim.hpp"
#include "firmware/platform/can_bus.hpp"
#include "protocol/can/local_wire.hpp"

namespace ligature::platform {

/// A lost bus of a simulated hand (URL `local:`) stays lost, because its peer is gone. A CAN interface may recover.
/// After it was down, the first frame that it delivers or takes shows that it is up; after bus-off, its driver reports
/// the restart. Frames received before that are dropped. Force does not return by itself, because losing the bus is a
/// latched fault.
class SocketBus final : public CanBus {
 public:
  /// Takes ownership of the descriptor, which must be non-blocking.
  explicit SocketBus(int descriptor, BusClaim claim = {}, can::Network network = can::Network::kClassic) noexcept
      : fd_(descriptor), claim_(std::move(claim)), network_(network) {}
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
  bool take_error_frame(std::span<const std::uint8_t> packet) noexcept;

  int fd_;
  BusClaim claim_;
  can::Network network_;
  Loss loss_ = Loss::kNone;
};

enum class OpenFailure : std::uint8_t {
  kUsage,     ///< bad URL: retrying is useless
  kNotThere,  ///< no peer yet, or interface down: may be retried
  kTaken,     ///< used by another controller on this machine
};
struct OpenError {
  OpenFailure kind;
  std::string text;  ///< one line
};

/// Opens `local:/path/socket` (where the simulated hand listens) or `socketcan:can0`, for exclusive use until closed.
/// @param network of the drives; an interface that cannot carry FD frames is refused for kFd
[[nodiscard]] std::variant<std::unique_ptr<CanBus>, OpenError> open_can_bus(
    const std::string& url, can::Network network = can::Network::kClassic);

}  // namespace ligature::platform
