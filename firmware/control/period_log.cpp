#include "firmware/control/period_log.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "firmware/control/tick_report.hpp"
#include "firmware/rt/period.hpp"

namespace ligature::control {
namespace {

using std::chrono::nanoseconds;
constexpr std::int32_t kOfOneTick = rt::kDeadlineMissed | rt::kOverworked | rt::kThreadLate | rt::kThreadCut;

template <class Narrow = std::int32_t>
Narrow narrow(std::int64_t value) noexcept {
  return static_cast<Narrow>(std::min<std::int64_t>(value, std::numeric_limits<Narrow>::max()));
}

}  // namespace

void PeriodLog::begin(std::int64_t tick, const Phases& at, nanoseconds work, const rt::WireTorque& torque,
                      const Controller& controller, const ThreadOrders& orders, std::int64_t grasp_age_ticks) noexcept {
  timing_.wakeup.add((at.woke - at.scheduled).count());
  timing_.control.add((at.controlled - at.woke).count());
  timing_.execution.add((at.done - at.woke).count());
  timing_.work.add(work.count());
  const bool missed = at.done >= at.scheduled + rt::kPeriod, overworked = work > most_work_;
  timing_.deadline_misses += missed;
  timing_.overworked += overworked;

  record_ = {};
  record_.tick = tick;
  record_.scheduled_ns = at.scheduled.count();
  record_.wakeup_latency_ns = narrow((at.woke - at.scheduled).count());
  record_.sync_ns = narrow((at.synced - at.woke).count());
  record_.tpdo_ns = narrow((at.sampled - at.woke).count());
  record_.law_ns = narrow((at.decided - at.woke).count());
  record_.control_ns = narrow((at.controlled - at.woke).count());
  record_.execution_ns = narrow((at.done - at.woke).count());
  record_.flags = (missed ? rt::kDeadlineMissed : 0) | (overworked ? rt::kOverworked : 0);
  record_.torque_permille = torque;
  record_.grasp_age_ticks = narrow<std::int16_t>(grasp_age_ticks);
  report(controller, record_);
  report(orders, record_);
  woke_ = at.woke;
  begun_ = true;
}

void PeriodLog::lose(std::int64_t tick, nanoseconds scheduled, std::int64_t periods) noexcept {
  if (lost_ == 0) lost_tick_ = tick, lost_scheduled_ = scheduled;
  lost_ += periods;
  timing_.periods_lost += static_cast<std::uint64_t>(periods);
}

void PeriodLog::finish(const ThreadResult& thread, std::int64_t late_ticks) noexcept {
  if (begun_ && late_ticks > 0) {
    record_.flags |= rt::kThreadLate;
    ++timing_.thread_late;
  }
  tell(thread);
}

void PeriodLog::finish_last(const ThreadResult& thread) noexcept { tell(thread); }

void PeriodLog::tell(const ThreadResult& thread) noexcept {
  if (begun_) {
    report(thread.health, record_);
    for (std::size_t h = 0; h < rt::kHands; ++h) report(thread.hand[h], h, record_);
    tell_steps(thread);
    if (thread.tick == record_.tick) {
      record_.thread_start_ns = narrow((thread.began - woke_).count());
      record_.thread_done_ns = narrow((thread.done - woke_).count());
      record_.thread_work_ns = narrow(thread.work.count());
      const bool cut = thread.health.end == physics::TickEnd::kClock;
      if (cut) record_.flags |= rt::kThreadCut;
      timing_.thread.add(thread.work.count());
      timing_.thread_cut += cut;
      timing_.thread_lost_ticks += thread.health.time_lost;
    } else {  // the values in `health` belong to an older tick
      record_.thread_end = 0;
      record_.thread_cut_at = -1;
      record_.time_lost = 0.0F;
    }
    out_.tell(record_);
    begun_ = false;
  }
  tell_lost();
}

/// Enters into the record all physics ticks that were completed since the last record.
void PeriodLog::tell_steps(const ThreadResult& thread) noexcept {
  record_.thread_steps = narrow<std::int8_t>(thread.steps - std::exchange(steps_, thread.steps));
  const auto told = std::min<std::size_t>(static_cast<std::size_t>(record_.thread_steps), rt::kThreadSteps);
  for (std::size_t i = 0; i < told; ++i) {
    const ThreadStep& step = thread.last_steps[told - 1 - i];
    record_.step_age_ticks[i] = narrow(record_.tick - step.tick);
    record_.step_cut_at[i] = step.cut_at;
  }
}

/// Writes a record for each lost period: the last values again, with the flag kPeriodLost. If the ring is full, the
/// remaining records are counted as dropped.
void PeriodLog::tell_lost() noexcept {
  const auto room = static_cast<std::int64_t>(out_.room());
  record_.flags |= rt::kPeriodLost;
  record_.flags &= ~kOfOneTick;  // these flags concern the executed tick only
  record_.thread_steps = 0;
  record_.step_age_ticks = record_.step_cut_at = {-1, -1, -1};
  for (std::int64_t i = 0; i < lost_; ++i) {
    if (i >= room) {
      out_.count_untold(static_cast<std::uint64_t>(lost_ - i));
      break;
    }
    record_.tick = lost_tick_ + i;
    record_.scheduled_ns = (lost_scheduled_ + i * rt::kPeriod).count();
    out_.tell(record_);
  }
  lost_ = 0;
}

}  // namespace ligature::control
