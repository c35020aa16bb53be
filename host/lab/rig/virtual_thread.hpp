#pragma once
// The thread's physics beside the loop, on a clock that is a number: it runs in the gaps in which the loop sleeps or
// waits, and takes as much simulated time as it is told to.

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <utility>

#include "firmware/thread_context.hpp"

namespace ligature::lab {

/// Stands for the thread that ThreadContext::run() has in the program. Whoever moves the simulated time calls advance()
/// before the loop looks: a request is taken up at the moment at which it would have been, and its result is there from
/// the moment on at which the tick has ended.
class VirtualThread {
 public:
  VirtualThread(const Nanoseconds& now, physics::Simulation& thread, control::ThreadExchange& exchange,
                rt::LatestValue<rt::ThreadSnapshot>& shape) noexcept
      : now_(now), context_(clock_, thread, exchange, shape) {}
  VirtualThread(const VirtualThread&) = delete;
  VirtualThread& operator=(const VirtualThread&) = delete;

  Nanoseconds per_question{0};                      ///< what lies between two questions for the time, before and after
  std::function<Nanoseconds(std::int64_t)> stalls;  ///< of a tick: so much longer, and nobody asks

  /// The loop's wake-up.
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
    Nanoseconds worked() noexcept {  // before a tick, and after it
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
