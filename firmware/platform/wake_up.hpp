#pragma once
// One thread wakes another: the one call between the two real-time contexts that is neither bus nor clock.

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>

namespace ligature::platform {

/// A count that the one raises and the other waits on (futex). Raising never waits; a wake-up that comes while nobody
/// waits is not lost, and several of them are one.
///
/// Memory order: what the waker wrote before wake() is seen after wait(), by release on the count and acquire of it.
class WakeUp {
 public:
  void wake() noexcept {
    count_.fetch_add(2, std::memory_order_release);
    call(FUTEX_WAKE_PRIVATE, 1);
  }
  /// The last wake-up: from now on wait() says that it is over.
  void end() noexcept {
    count_.fetch_or(kEnd, std::memory_order_release);
    call(FUTEX_WAKE_PRIVATE, 1);
  }

  /// One thread only: sleeps until there was a wake-up since the last call. @return false when it is over.
  bool wait() noexcept {
    std::uint32_t now = 0;
    while ((now = count_.load(std::memory_order_acquire)) == seen_) call(FUTEX_WAIT_PRIVATE, seen_);
    seen_ = now;
    return (now & kEnd) == 0;
  }

 private:
  static constexpr std::uint32_t kEnd = 1;
  void call(int what, std::uint32_t value) noexcept {
    // The kernel compares the count itself, so a wake-up between the load above and this call is not slept through.
    syscall(SYS_futex, reinterpret_cast<std::uint32_t*>(&count_), what, value, nullptr, nullptr, 0);
  }

  std::atomic<std::uint32_t> count_{0};
  std::uint32_t seen_ = 0;
  static_assert(sizeof(count_) == sizeof(std::uint32_t) && std::atomic<std::uint32_t>::is_always_lock_free);
};

}  // namespace ligature::platform
