#pragma once
// Something large, lent to the real-time thread and given back by it.

#include <atomic>

namespace ligature::rt {

/// One object at a time goes over and comes back; what is exchanged with it, the borrower decides. Both sides are
/// wait-free: a load when nothing is there, one exchange or store when something is. The lender owns the object all
/// along and must not touch it between offer() and the collect() that returns it; so it is the lender that builds and
/// destroys, and the real-time thread does neither.
///   offer: store-release ---> take: exchange-acquire      give_back: store-release ---> collect: exchange-acquire
template <class T>
class Handover {
 public:
  /// Lender: @pre the last object has been collected.
  void offer(T* object) noexcept { forth_.store(object, std::memory_order_release); }
  /// Lender: what has come back, or nullptr.
  [[nodiscard]] T* collect() noexcept { return swap_out(back_); }

  /// Real time: what is there, or nullptr.
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
