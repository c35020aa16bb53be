#pragma once
// Lends a large object to the real-time thread, which gives it back.

#include <atomic>

namespace ligature::rt {

/// One object at a time is lent to the other thread and returned; the borrower may exchange the object's contents. Both
/// sides are wait-free: one load if nothing is there, else one exchange or store. The lender owns the object
/// throughout, but must not touch it between offer() and the collect() that returns it. So only the lender builds and
/// destroys, and the real-time thread never does.
///   offer: store-release ---> take: exchange-acquire      give_back: store-release ---> collect: exchange-acquire
template <class T>
class Handover {
 public:
  /// Lender: lends an object. @pre the previous one has been collected.
  void offer(T* object) noexcept { forth_.store(object, std::memory_order_release); }
  /// Lender: the returned object, or nullptr.
  [[nodiscard]] T* collect() noexcept { return swap_out(back_); }

  /// Real-time thread: the offered object, or nullptr.
  [[nodiscard]] T* take() noexcept { return swap_out(forth_); }
  void give_back(T* object) noexcept { back_.store(object, std::memory_order_release); }

 private:
  static T* swap_out(std::atomic<T*>& slot) noexcept {
    if (slot.load(std::memory_order_relaxed) == nullptr) return nullptr;
    return slot.exchange(nullptr, std::memory_order_acquire);
  }

  std::atomic<T*> forth_{nullptr}, back_{nullptr};
  static_assert(std::atomic<T*>::is_always_lock_free);
};

}  // namespace ligature::rt
