#pragma once
// Wakes one thread from another. Of the loop's system calls only this one concerns neither bus nor clock.

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>

namespace ligature::platform {

/// A counter that one thread increments and another waits on (futex). wake() never blocks. A wake-up while nobody waits
/// is not lost; several wake-ups count as one.
///
/// Memory order: writes before wake() are visible after wait() (release on the counter, acquire in wait()).
class WakeUp {
 public:
  void wake() noexcept {
    count_.fetch_add(2, std::memory_order_release);
    call(FUTEX_WAKE_PRIVATE, 1);
  }
  /// Last wake-up: from now on wait() returns false.
  void end() noexcept {
    count_.fetch_or(kEnd, std::memory_order_release);
    call(FUTEX_WAKE_PRIVATE, 1);
  }

  /// For one waiting thread: sleeps until there was a wake-up since the last call. @return false after end().
  bool wait() noexcept {
    std::uint32_t now = 0;
    while ((now = count_.load(std::memory_order_acquire)) == seen_) call(FUTEX_WAIT_PRIVATE, seen_);
    seen_ = now;
    return (now & kEnd) == 0;
  }

 private:
  static constexpr std::uint32_t kEnd = 1;
  void call(int what, std::uint32_t value) noexcept {
    // The kernel compares the counter again before sleeping, so a wake-up between the load and this call is not missed.
    syscall(SYS_futex, reinterpret_cast<std::uint32_t*>(&count_), what, value, nullptr, nullptr, 0);
  }

  std::atomic<std::uint32_t> count_{0};
  std::uint32_t seen_ = 0;
  static_assert(sizeof(count_) == sizeof(std::uint32_t) && std::atomic<std::uint32_t>::is_always_lock_free);
};

}  // namespace ligature::platform
