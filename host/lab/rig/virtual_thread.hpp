#pragma once
// Runs the thread's physics on the simulated clock: in the gaps in which the loop sleeps or waits, and for a simulated
// duration that can be set.

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <utility>

#include "firmware/thread_context.hpp"

namespace ligature::lab {

/// Replaces the thread of execution that runs ThreadContext::run() in the firmware. The code that advances the
/// simulated time must call advance() before the loop reads results: a request is then started at its proper time, and
/// its result becomes visible at the time at which the tick ends.
class VirtualThread {
 public:
  VirtualThread(const Nanoseconds& now, physics::Simulation& thread, control::ThreadExchange& exchange,
                rt::LatestValue<rt::ThreadSnapshot>& shape) noexcept
      : now_(now), context_(clock_, thread, exchange, shape) {}
  VirtualThread(const VirtualThread&) = delete;
  VirtualThread& operator=(const VirtualThread&) = delete;

  Nanoseconds per_question{0};  ///< simulated time between two checks of the clock during a tick
  /// additional time of a tick in which the clock is not checked (a stall), by tick number
  std::function<Nanoseconds(std::int64_t)> stalls;

  /// The loop wakes the physics.
  void wake() noexcept {
    woken_ = true;
    woken_at_ = now_;
    advance();
  }

  void advance() noexcept {
    for (;;) {
      if (busy_) {
        if (clock_.time > now_) return;
        context_.publish();
        busy_ = false;
      }
      if (!woken_) return;
      woken_ = false;
      clock_.time = std::max(clock_.time, woken_at_);
      if (!context_.take()) return;
      clock_.per_question = per_question;
      if (stalls) clock_.stall = stalls(++taken_ - 1);
      context_.compute();
      busy_ = true;
    }
  }

 private:
  struct Clock {
    Nanoseconds now() noexcept {
      if (inside) time += per_question;
      return time;
    }
    void sleep_until(Nanoseconds) noexcept {}
    Nanoseconds worked() noexcept {  // called at the start and at the end of a tick
      if (std::exchange(inside, !inside)) time += std::exchange(stall, Nanoseconds::zero());
      return time;
    }
    Nanoseconds time{0}, per_question{0}, stall{0};
    bool inside = false;
  };

  const Nanoseconds& now_;
  Clock clock_;
  ThreadContext<Clock> context_;
  bool busy_ = false, woken_ = false;
  Nanoseconds woken_at_{0};
  std::int64_t taken_ = 0;
};

}  // namespace ligature::lab
