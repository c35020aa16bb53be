#pragma once
// Waiting for frames of several buses, with a deadline.

#include <array>

#include "firmware/platform/can_bus.hpp"
#include "firmware/platform/monotonic_clock.hpp"

namespace ligature::platform {

/// Tests put virtual time behind this.
class BusWait {
 public:
  virtual ~BusWait() = default;
  [[nodiscard]] virtual Nanoseconds now() noexcept = 0;
  /// Sleeps until a bus has something to say or the deadline comes. @return false when the deadline has passed.
  virtual bool wait(Nanoseconds deadline) noexcept = 0;
};

/// ppoll on both hands' sockets. A lost bus, always readable, is left out, so that waiting never becomes spinning.
class PollWait final : public BusWait {
 public:
  PollWait(const CanBus& left, const CanBus& right) noexcept : buses_{&left, &right} {}
  [[nodiscard]] Nanoseconds now() noexcept override { return clock_.now(); }
  bool wait(Nanoseconds deadline) noexcept override;

 private:
  std::array<const CanBus*, 2> buses_;
  MonotonicClock clock_;
};

}  // namespace ligature::platform
