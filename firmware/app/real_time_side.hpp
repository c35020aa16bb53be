#pragma once
// The control loop, the suture's physics, the objects that both use, and the two operating-system threads that run
// them.

#include <atomic>
#include <future>
#include <optional>
#include <thread>

#include "firmware/app/rig_setup.hpp"
#include "firmware/cycle.hpp"
#include "firmware/platform/idle_guard.hpp"
#include "firmware/platform/monotonic_clock.hpp"
#include "firmware/platform/realtime.hpp"
#include "firmware/platform/rig_bus.hpp"
#include "firmware/platform/wake_up.hpp"
#include "firmware/thread_context.hpp"

namespace ligature::app {

/// Two operating-system threads. Each first requests its real-time rights and reports refusals. The loop's thread then
/// waits for start(); if end() is called before start(), it ends without running the loop. The physics thread waits for
/// the loop.
class RealTimeSide {
 public:
  using RigCycle = Cycle<platform::RigBus, platform::MonotonicClock, platform::WakeUp>;

  RealTimeSide(const RunOptions& options, Plan& plan, const Buses& buses, rt::Outlets& outlets,
               control::PlantHandover& plants);
  ~RealTimeSide() { end(); }
  RealTimeSide(const RealTimeSide&) = delete;
  RealTimeSide& operator=(const RealTimeSide&) = delete;

  /// Requests real-time rights for the process and starts both threads, which request their own. @param ask false: no
  /// rights are requested. @return the rights that were refused, each already logged.
  platform::Refusals prepare(bool ask, int core);
  void start();
  /// Waits until the loop has ended; if start() was not called, the loop never runs.
  void end();

  [[nodiscard]] bool is_beating() const noexcept { return beating_; }
  [[nodiscard]] const RigCycle& cycle() const noexcept { return cycle_; }               // valid after end()
  [[nodiscard]] control::Fault fault() const noexcept { return controller_.fault(); }   // valid after end()
  [[nodiscard]] rt::Culprit culprit() const noexcept { return controller_.culprit(); }  // likewise

 private:
  void stay_awake();
  void release();

  void run_physics(bool ask, int core);

  const Buses& buses_;
  platform::PollWait wait_;
  platform::RigBus bus_;
  platform::MonotonicClock clock_;
  control::Controller controller_;
  control::ThreadExchange exchange_;
  platform::WakeUp wake_physics_;
  RigCycle cycle_;
  ThreadContext<platform::MonotonicClock> physics_;
  int physics_core_;
  std::promise<platform::Refusals> rights_, physics_rights_;
  std::promise<bool> go_;
  std::atomic<bool> beating_{true};
  std::optional<platform::IdleGuard> awake_;
  bool started_ = false;
  std::thread thread_, physics_thread_;
};

}  // namespace ligature::app
