#pragma once
// What went out to one hand's drives, SYNC by SYNC.

#include <algorithm>
#include <array>
#include <cstdint>

#include "firmware/physics/types.hpp"

namespace ligature::control {

/// Cycle i goes from its SYNC to the next one's. In it the drives make what cycle i - 1 sent, constant (zero-order
/// hold), or what they made before if that frame was lost. A lost period has no SYNC: the cycle before it lasts
/// longer, and work is counted from SYNC to SYNC, whatever the time between. All O(1) but cycle_of(), O(kMemory).
class SentTorques {
 public:
  static constexpr std::int64_t kMemory = 64;  ///< cycles; longer than any watchdog
  using Vec3 = physics::Vec3;

  struct Cycle {
    std::int64_t tick = -1;
    Vec3 torque_Nm = Vec3::Zero();
    Vec3 f_N = Vec3::Zero();  ///< tip force that the torques make
  };

  /// SYNC of period `tick` has gone out. Again, or for an older one: nothing changes.
  void begin(std::int64_t tick) noexcept {
    if (tick <= at(newest_).tick) return;
    const Cycle held{tick, at(newest_).torque_Nm, at(newest_).f_N};  // until send() says what
    ring_[index(++newest_)] = held;
  }
  /// In the newest cycle.
  void send(const Vec3& torque_Nm, const Vec3& f_N) noexcept {
    Cycle& now = ring_[index(newest_)];
    now.torque_Nm = torque_Nm, now.f_N = f_N;
  }

  [[nodiscard]] std::int64_t newest() const noexcept { return newest_; }
  /// Nothing was sent in cycles before the first, nor in those that are forgotten.
  [[nodiscard]] const Cycle& at(std::int64_t i) const noexcept {
    return i >= 0 && i <= newest_ && i > newest_ - kMemory ? ring_[index(i)] : kNothing;
  }
  /// The last one whose SYNC went out in period `tick` or before; one that is remembered, if any is.
  [[nodiscard]] std::int64_t cycle_of(std::int64_t tick) const noexcept {
    const std::int64_t oldest = std::max<std::int64_t>(0, newest_ - kMemory + 2);
    std::int64_t i = newest_;
    while (i > oldest && at(i).tick > tick) --i;
    return i;
  }
  /// Periods that it lasted; the newest: one.
  [[nodiscard]] std::int64_t periods(std::int64_t i) const noexcept {
    return i < newest_ ? at(i + 1).tick - at(i).tick : 1;
  }

 private:
  static const Cycle kNothing;
  [[nodiscard]] static std::size_t index(std::int64_t i) noexcept {
    return static_cast<std::size_t>(std::max<std::int64_t>(i, 0) % kMemory);
  }

  std::int64_t newest_ = -1;
  std::array<Cycle, static_cast<std::size_t>(kMemory)> ring_{};
};

inline const SentTorques::Cycle SentTorques::kNothing{};

}  // namespace ligature::control
