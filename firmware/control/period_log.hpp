#pragma once
// Reports each period of the loop in a tick record, once the period's physics result is known, and keeps statistics of
// the run.

#include <chrono>
#include <cstdint>

#include "firmware/control/controller.hpp"
#include "firmware/control/thread_link.hpp"
#include "firmware/rt/cycle_timing.hpp"
#include "firmware/rt/outlets.hpp"

namespace ligature::control {

/// Times at which the phases of a tick ended, on the loop's clock.
struct Phases {
  std::chrono::nanoseconds scheduled, woke, synced, sampled, decided, controlled, done;
};

/// A period's record needs the physics result, which comes only in the next period. So begin() is called in the period
/// itself, and finish() in the next one, whether the result has come or is late. Lost periods get a copy of the record
/// with a flag. No allocation after construction.
class PeriodLog {
 public:
  /// @param most_work computing time of the loop above which a tick is flagged as overworked
  PeriodLog(rt::Outlets& out, std::chrono::nanoseconds most_work) noexcept : out_(out), most_work_(most_work) {}

  void begin(std::int64_t tick, const Phases& at, std::chrono::nanoseconds work, const rt::WireTorque& torque,
             const Controller& controller, const ThreadOrders& orders, std::int64_t grasp_age_ticks) noexcept;
  /// Notes periods that the loop has skipped; `tick` and `scheduled` are those of the first one.
  void lose(std::int64_t tick, std::chrono::nanoseconds scheduled, std::int64_t periods) noexcept;
  /// Writes the record that was begun, and the records of periods lost since. @param late_ticks how far the physics is
  /// behind.
  void finish(const ThreadResult& thread, std::int64_t late_ticks) noexcept;
  /// As finish(), at the end of a run, where the last result is neither awaited nor reported as late.
  void finish_last(const ThreadResult& thread) noexcept;

  [[nodiscard]] const rt::CycleTiming& timing() const noexcept { return timing_; }

 private:
  void tell(const ThreadResult& thread) noexcept;
  void tell_steps(const ThreadResult& thread) noexcept;
  void tell_lost() noexcept;

  rt::Outlets& out_;
  std::chrono::nanoseconds most_work_;
  rt::CycleTiming timing_;
  rt::TickRecord record_;
  std::chrono::nanoseconds woke_{};  // of the tick in record_
  bool begun_ = false;
  std::int64_t steps_ = 0;  // physics ticks already reported
  std::int64_t lost_ = 0, lost_tick_ = 0;
  std::chrono::nanoseconds lost_scheduled_{};
};

}  // namespace ligature::control
