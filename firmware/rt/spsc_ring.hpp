#pragma once
// Wait-free queue between exactly two threads.

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "firmware/rt/payload.hpp"

namespace ligature::rt {

/// Cache-line size of all supported machines. A constant, because std::hardware_destructive_interference_size depends
/// on compiler flags, so the layout could differ between translation units.
inline constexpr std::size_t kCacheLine = 64;

/// Bounded single-producer single-consumer ring, wait-free on both sides: no lock, no loop, no system call, no
/// allocation after construction. If the ring is full, push() drops the new value and counts it, so that a slow
/// consumer never delays the producer (the real-time thread).
///
///   | head (producer) + its copy of tail | pad | tail (consumer) + its copy of head | pad | slots ... |
///
/// Memory order. `head_` counts values pushed, `tail_` values popped; both only grow, slot = count mod capacity.
///  * The producer writes the slot, then stores head_ with release; the consumer loads head_ with acquire, then reads
///    the slot. So a value is complete when the consumer sees it.
///  * The consumer reads the slot, then stores tail_ with release; the producer loads tail_ with acquire before it
///    writes a slot again. So no slot is overwritten while it is being read.
///  * Each side loads its own counter relaxed (only it writes it) and keeps a copy of the other's, refreshed only
///    when the copy says full or empty. So the other side's cache line is fetched once per batch, not once per value.
template <Payload T>
class SpscRing {
 public:
  /// @param capacity number of values, >= 1. Allocates and touches all memory here.
  explicit SpscRing(std::size_t capacity)
      : capacity_(std::max<std::size_t>(capacity, 1)), slots_(std::make_unique<T[]>(capacity_)) {}

  /// Producer only. @return false when full: the value is dropped and counted.
  bool push(const T& value) noexcept {
    const std::uint64_t head = head_.load(std::memory_order_relaxed);
    if (head - tail_seen_ == capacity_) {
      tail_seen_ = tail_.load(std::memory_order_acquire);
      if (head - tail_seen_ == capacity_) {
        count_dropped(1);
        return false;
      }
    }
    slots_[head % capacity_] = value;
    head_.store(head + 1, std::memory_order_release);
    return true;
  }

  /// Consumer only. @return false when empty; `value` is then untouched.
  bool pop(T& value) noexcept {
    const std::uint64_t tail = tail_.load(std::memory_order_relaxed);
    if (tail == head_seen_) {
      head_seen_ = head_.load(std::memory_order_acquire);
      if (tail == head_seen_) return false;
    }
    value = slots_[tail % capacity_];
    tail_.store(tail + 1, std::memory_order_release);
    return true;
  }

  /// Producer only: counts values that were dropped without calling push().
  void count_dropped(std::uint64_t n) noexcept {
    dropped_.store(dropped_.load(std::memory_order_relaxed) + n, std::memory_order_relaxed);
  }

  /// Any thread; relaxed, not synchronised with the values.
  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::size_t capacity() const noexcept { return capacity_; }

 private:
  const std::size_t capacity_;
  const std::unique_ptr<T[]> slots_;
  alignas(kCacheLine) std::atomic<std::uint64_t> head_{0};
  std::uint64_t tail_seen_ = 0;
  std::atomic<std::uint64_t> dropped_{0};
  alignas(kCacheLine) std::atomic<std::uint64_t> tail_{0};
  std::uint64_t head_seen_ = 0;
  static_assert(std::atomic<std::uint64_t>::is_always_lock_free);
};

}  // namespace ligature::rt
