#pragma once
// The simulated hand in real time: waits for frames or for the device's next moment, never spins.

#include <csignal>
#include <vector>

#include "sim_device/fault_injector.hpp"
#include "sim_device/hand_device.hpp"
#include "sim_device/port.hpp"

namespace ligature::sim {

/// CLOCK_MONOTONIC.
[[nodiscard]] Time now_monotonic() noexcept;

struct LoopStats {
  std::int64_t wakeups = 0;
  Time worst_lateness{};    ///< of a timed wake-up
  std::int64_t stalls = 0;  ///< looks at the socket that found several SYNCs: this process had been late
};

class EventLoop {
 public:
  /// @param faults what shall go wrong on the way out; may be missing.
  EventLoop(HandDevice& device, Port& port, FaultInjector* faults = nullptr)
      : device_(device), port_(port), faults_(faults) {}

  /// One round: take frames in, let time pass in the device, send what is due.
  void serve(Time now);
  /// Sleeps until a frame, the device's next moment, a signal that `during_sleep` lets through, or `at_most`.
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
