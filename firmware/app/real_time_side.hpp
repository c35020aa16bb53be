#pragma once
// The loop, all it works with, and the thread that runs it.

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

namespace ligature::app {

/// The thread asks for its rights at once, says what was refused, and waits for the word to start; it never starts
/// without one.
class RealTimeSide {
 public:
  using RigCycle = Cycle<platform::RigBus, platform::MonotonicClock>;

  RealTimeSide(const RunOptions& options, Plan& plan, const Buses& buses, rt::Outlets& outlets,
               control::PlantHandover& plants);
  ~RealTimeSide() { end(); }
  RealTimeSide(const RealTimeSide&) = delete;
  RealTimeSide& operator=(const RealTimeSide&) = delete;

  /// @param ask false: for no right at all. @return what was refused, each already logged.
  platform::Refusals prepare(bool ask, int core);
  void start();
  /// Waits for the loop's end; without start() it never began.
  void end();

  [[nodiscard]] bool is_beating() const noexcept { return beating_; }
  [[nodiscard]] const RigCycle& cycle() const noexcept { return cycle_; }              // after end()
  [[nodiscard]] control::Fault fault() const noexcept { return controller_.fault(); }  // after end()

 private:
  void stay_awake();
  void release();

  const Buses& buses_;
  platform::PollWait wait_;
  platform::RigBus bus_;
  platform::MonotonicClock clock_;
  control::Controller controller_;
  RigCycle cycle_;
  std::promise<platform::Refusals> rights_;
  std::promise<bool> go_;
  std::atomic<bool> beating_{true};
  std::optional<platform::IdleGuard> awake_;
  bool started_ = false;
  std::thread thread_;
};

}  // namespace ligature::app
