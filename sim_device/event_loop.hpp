#pragma once
// Runs the simulated hand in real time: sleeps until frames arrive or the device's next event is due.

#include <csignal>
#include <vector>

#include "sim_device/fault_injector.hpp"
#include "sim_device/hand_device.hpp"
#include "sim_device/port.hpp"

namespace ligature::sim {

/// Time of CLOCK_MONOTONIC.
[[nodiscard]] Time now_monotonic() noexcept;

struct LoopStats {
  std::int64_t wakeups = 0;
  Time worst_lateness{};    ///< largest delay of a wake-up by the timer
  std::int64_t stalls = 0;  ///< reads that found several SYNCs, because this process was late
};

class EventLoop {
 public:
  /// @param faults modifies the outgoing frames; may be null.
  EventLoop(HandDevice& device, Port& port, FaultInjector* faults = nullptr)
      : device_(device), port_(port), faults_(faults) {}

  /// One round: receives frames, advances the device, sends what is due.
  void serve(Time now);
  /// Sleeps until a frame arrives, the device's next event is due, a signal allowed by `during_sleep` comes, or
  /// `at_most`.
  void wait(Time at_most, const sigset_t& during_sleep);
  [[nodiscard]] const LoopStats& stats() const noexcept { return stats_; }

 private:
  HandDevice& device_;
  Port& port_;
  FaultInjector* faults_;
  LoopStats stats_;
  Time last_look_{};
  std::vector<Received> received_;
  std::vector<int> left_;
  std::vector<pollfd> fds_;
};

}  // namespace ligature::sim
