#pragma once
// The newest value of something, from one thread to another; older ones are forgotten.

#include <array>
#include <atomic>
#include <cstdint>

#include "firmware/rt/payload.hpp"
#include "firmware/rt/spsc_ring.hpp"

namespace ligature::rt {

/// Triple buffer: one writer, one reader, both wait-free as long as they assign what neither allocates nor throws; values
/// of any size, never torn.
///
/// Three slots, and at any time the writer owns one (`back_`), the reader owns one (`front_`), and the third is named
/// by the atomic `middle_`. publish() and refresh() each swap their own slot with the middle one in a single exchange,
/// so no slot ever has two owners and the bytes need no atomics. acq_rel on both exchanges: release hands over what
/// was written (or the promise to read no more), acquire takes what the other side handed over. A bit in `middle_`
/// tells whether it holds news.
template <class T>
class LatestValue {
 public:
  /// Writer only: the slot to fill. What it holds is some older value.
  [[nodiscard]] T& back() noexcept { return slots_[back_].value; }

  /// Writer only: makes back() the newest value.
  void publish() noexcept {
    back_ = static_cast<std::uint8_t>(
        middle_.exchange(static_cast<std::uint8_t>(back_ | kNews), std::memory_order_acq_rel) & kSlot);
  }

  /// Writer only: publishes a copy.
  void store(const T& value) noexcept
    requires Payload<T>
  {
    back() = value;
    publish();
  }

  /// Reader only: moves to the newest value. @return true when there was news since the last call.
  bool refresh() noexcept {
    if ((middle_.load(std::memory_order_relaxed) & kNews) == 0) return false;
    front_ = static_cast<std::uint8_t>(middle_.exchange(front_, std::memory_order_acq_rel) & kSlot);
    return true;
  }

  /// Reader only: the value of the last refresh(); a default one before the first news.
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
