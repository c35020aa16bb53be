#pragma once
// Passes the newest value from one thread to another; older values are overwritten.

#include <array>
#include <atomic>
#include <cstdint>

#include "firmware/rt/payload.hpp"
#include "firmware/rt/spsc_ring.hpp"

namespace ligature::rt {

/// Triple buffer for one writer and one reader. Both are wait-free (if assigning a T neither allocates nor throws).
/// Values of any size, never torn.
///
/// Three slots: at any time the writer owns one (`back_`), the reader owns one (`front_`), and the atomic `middle_`
/// holds the index of the third. publish() and refresh() swap their own slot with the middle one in a single exchange,
/// so no slot ever has two owners and the values need no atomics. Both exchanges are acq_rel: release publishes what
/// was written (or that reading has ended), acquire sees what the other side published. A bit in `middle_` tells
/// whether the middle slot holds a new value.
template <class T>
class LatestValue {
 public:
  /// Writer only: the slot to fill; it contains some older value.
  [[nodiscard]] T& back() noexcept { return slots_[back_].value; }

  /// Writer only: makes back() the newest value.
  void publish() noexcept {
    back_ = static_cast<std::uint8_t>(
        middle_.exchange(static_cast<std::uint8_t>(back_ | kNews), std::memory_order_acq_rel) & kSlot);
  }

  /// Writer only: publishes a copy.
  void store(const T& value) noexcept requires Payload<T> {
    back() = value;
    publish();
  }

  /// Reader only: takes the newest value. @return true if there was a new one since the last call.
  bool refresh() noexcept {
    if ((middle_.load(std::memory_order_relaxed) & kNews) == 0) return false;
    front_ = static_cast<std::uint8_t>(middle_.exchange(front_, std::memory_order_acq_rel) & kSlot);
    return true;
  }

  /// Reader only: the value of the last refresh(); default-constructed before the first.
  [[nodiscard]] const T& front() const noexcept { return slots_[front_].value; }

 private:
  static constexpr std::uint8_t kSlot = 3;
  static constexpr std::uint8_t kNews = 4;
  struct alignas(kCacheLine) Slot {
    T value{};
  };
  std::array<Slot, 3> slots_{};
  alignas(kCacheLine) std::uint8_t back_ = 0;
  alignas(kCacheLine) std::atomic<std::uint8_t> middle_{1};
  alignas(kCacheLine) std::uint8_t front_ = 2;
};

}  // namespace ligature::rt
