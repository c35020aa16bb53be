#pragma once
// A CAN network as its master uses it, independent of the transport.

#include <cstdint>

#include "protocol/can/frame.hpp"

namespace ligature::platform {

enum class Receive : std::uint8_t { kFrame, kNothing, kLost };

/// Why start-up ended: frames could not be queued.
inline constexpr const char* kTakesNoFrames =
    "the bus takes no frames (down, or bus-off); remedy: ligature-firmware doctor --can INTERFACE";

/// Never blocks or throws. A lost bus accepts no frames; if it can recover, it does so while send() or receive()
/// is called.
class CanBus {
 public:
  virtual ~CanBus() = default;
  /// @return false if the frame could not be queued (queue full, or bus lost); it is not retried.
  virtual bool send(const can::Frame& frame) noexcept = 0;
  virtual Receive receive(can::Frame& frame) noexcept = 0;
  [[nodiscard]] virtual bool is_lost() const noexcept = 0;
  /// Descriptor that becomes readable when a frame arrives or the bus is lost; -1: none.
  [[nodiscard]] virtual int descriptor() const noexcept = 0;
};

}  // namespace ligature::platform
