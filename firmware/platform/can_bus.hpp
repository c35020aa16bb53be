#pragma once
// One CAN network as its master uses it, whatever carries the frames.

#include <cstdint>

#include "protocol/can/frame.hpp"

namespace ligature::platform {

enum class Receive : std::uint8_t { kFrame, kNothing, kLost };

/// Never blocks, never throws. A bus that is lost takes no frames; one that can come back does so while it is read.
class CanBus {
 public:
  virtual ~CanBus() = default;
  /// @return false when the frame could not be queued (full, or lost); the next period will send another.
  virtual bool send(const can::Frame& frame) noexcept = 0;
  virtual Receive receive(can::Frame& frame) noexcept = 0;
  [[nodiscard]] virtual bool is_lost() const noexcept = 0;
  /// File descriptor that becomes readable with a frame or a loss; -1 when there is none to wait for.
  [[nodiscard]] virtual int descriptor() const noexcept = 0;
};

}  // namespace ligature::platform
