#pragma once
// What the loop says about each period: a record once all of it is known, and statistics of the run.

#include <chrono>
#include <cstdint>

#include "firmware/control/controller.hpp"
#include "firmware/control/thread_link.hpp"
#include "firmware/rt/cycle_timing.hpp"
#include "firmware/rt/outlets.hpp"

namespace ligature::control {

/// When each phase of a tick ended, on the loop's clock.
struct Phases {
  std::chrono::nanoseconds scheduled, woke, synced, sampled, decided, controlled, done;
};

/// The record of a period waits for its thread: begin() in the period, finish() in the next one, when that thread's
/// result is in or late. Lost periods repeat it, flagged. No allocation after construction.
class PeriodLog {
 public:
  explicit PeriodLog(rt::Outlets& out) noexcept : out_(out) {}

  void begin(std::int64_t tick, const Phases& at, std::chrono::nanoseconds work, const rt::WireTorque& torque,
             const Controller& controller, const ThreadOrders& orders, std::int64_t grasp_age_ticks) noexcept;
  /// Periods in which nothing is done, the first with this number and this time.
  void lose(std::int64_t tick, std::chrono::nanoseconds scheduled, std::int64_t periods) noexcept;
  /// Tells what has begun, and what was lost since. @param late_ticks  by which the result is behind it.
  void finish(const ThreadResult& thread, std::int64_t late_ticks) noexcept;
  /// The same at the end of a run: nobody waits for the last thread, so it is not called late.
  void finish_last(const ThreadResult& thread) noexcept;

  [[nodiscard]] const rt::CycleTiming& timing() const noexcept { return timing_; }

 private:
  void tell(const ThreadResult& thread) noexcept;
  void tell_steps(const ThreadResult& thread) noexcept;
  void tell_lost() noexcept;

  rt::Outlets& out_;
  rt::CycleTiming timing_;
  rt::TickRecord record_;
  std::chrono::nanoseconds woke_{};  // of the record's tick
  bool begun_ = false;
  std::int64_t steps_ = 0;  // of the thread that were told
  std::int64_t lost_ = 0, lost_tick_ = 0;
  std::chrono::nanoseconds lost_scheduled_{};
};

}  // namespace ligature::control
