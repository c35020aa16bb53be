#pragma once
// History of the torques sent to one hand's drives, by SYNC.

#include <algorithm>
#include <array>
#include <cstdint>

#include "firmware/physics/types.hpp"

namespace ligature::control {

/// Cycle i lasts from one SYNC to the next. During this cycle the drives make the torque that was sent in cycle i - 1,
/// or an older one if that frame was lost. A lost period has no SYNC, so it makes the cycle longer. All functions are
/// O(1), except cycle_of(): O(kMemory).
class SentTorques {
 public:
  static constexpr std::int64_t kMemory = 64;  ///< cycles remembered; more than any watchdog's ticks
  using Vec3 = physics::Vec3;

  struct Cycle {
    std::int64_t tick = -1;
    Vec3 torque_Nm = Vec3::Zero();
    Vec3 f_N = Vec3::Zero();  ///< tip force that the torques make
  };

  /// Call when the SYNC of period `tick` was sent. No effect if this tick, or a later one, was begun before.
  void begin(std::int64_t tick) noexcept {
    if (tick <= at(newest_).tick) return;
    const Cycle held{tick, at(newest_).torque_Nm, at(newest_).f_N};  // until send() is called, the last torques count
    ring_[index(++newest_)] = held;
  }
  /// Records what was sent in the newest cycle.
  void send(const Vec3& torque_Nm, const Vec3& f_N) noexcept {
    Cycle& now = ring_[index(newest_)];
    now.torque_Nm = torque_Nm, now.f_N = f_N;
  }

  [[nodiscard]] std::int64_t newest() const noexcept { return newest_; }
  /// The torques sent in cycle i; zero for cycles before the first one and for forgotten ones (older than kMemory).
  [[nodiscard]] const Cycle& at(std::int64_t i) const noexcept {
    return i >= 0 && i <= newest_ && i > newest_ - kMemory ? ring_[index(i)] : kNothing;
  }
  /// The last cycle whose SYNC was sent in period `tick` or before, but no older one than the oldest remembered.
  [[nodiscard]] std::int64_t cycle_of(std::int64_t tick) const noexcept {
    const std::int64_t oldest = std::max<std::int64_t>(0, newest_ - kMemory + 2);
    std::int64_t i = newest_;
    while (i > oldest && at(i).tick > tick) --i;
    return i;
  }
  /// Duration of cycle i in periods; 1 for the newest.
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
