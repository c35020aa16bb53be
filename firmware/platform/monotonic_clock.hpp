#pragma once
// The clock of the real-time loop and of the physics thread.

#include <time.h>

#include <cerrno>
#include <chrono>

namespace ligature::platform {

using Nanoseconds = std::chrono::nanoseconds;

/// CLOCK_MONOTONIC; sleeps to absolute times, so that delays in one cycle do not shift the next.
class MonotonicClock {
 public:
  [[nodiscard]] Nanoseconds now() noexcept { return time_of(CLOCK_MONOTONIC); }

  /// CPU time of the calling thread, kernel time included, waiting excluded. Time taken away by a hypervisor is
  /// included if Linux does not know of it.
  [[nodiscard]] Nanoseconds worked() noexcept { return time_of(CLOCK_THREAD_CPUTIME_ID); }

  void sleep_until(Nanoseconds at) noexcept {
    const timespec t = to_timespec(at);
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) == EINTR) {
    }
  }

  [[nodiscard]] static timespec to_timespec(Nanoseconds t) noexcept {
    return {static_cast<time_t>(t.count() / 1'000'000'000), static_cast<long>(t.count() % 1'000'000'000)};
  }

 private:
  static Nanoseconds time_of(clockid_t clock) noexcept {
    timespec t{};
    clock_gettime(clock, &t);
    return std::chrono::seconds(t.tv_sec) + Nanoseconds(t.tv_nsec);
  }
};

}  // namespace ligature::platform
