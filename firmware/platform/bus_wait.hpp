#pragma once
// Waits for frames on several buses, with a deadline.

#include <array>

#include "firmware/platform/can_bus.hpp"
#include "firmware/platform/monotonic_clock.hpp"

namespace ligature::platform {

/// Interface, so that tests can use simulated time.
class BusWait {
 public:
  virtual ~BusWait() = default;
  [[nodiscard]] virtual Nanoseconds now() noexcept = 0;
  /// Sleeps until a bus is readable or the deadline is reached. @return false if the deadline has passed.
  virtual bool wait(Nanoseconds deadline) noexcept = 0;
};

/// ppoll() on both hands' sockets. A lost bus is always readable, so it is left out; otherwise waiting would busy-loop.
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
