#pragma once
// One hand of a simulated operator that ties: plays back planned positions with a short, constant delay.

#include <cstdint>
#include <span>
#include <vector>

#include "sim_device/deadline.hpp"
#include "sim_device/intention.hpp"
#include "sim_device/operator/sight.hpp"
#include "sim_device/workspace_map.hpp"

namespace ligature::sim {

/// Planned position and grip of both hands at one tick of the rig (a "wish").
struct WishedTick {
  std::int64_t due_ns = 0;  ///< time at which the tick was due, CLOCK_MONOTONIC
  std::array<HandWish, 2> hands{};
  bool is_done = false;  ///< the plan has ended
};

/// Wishes, one per tick of 1 ms, arrive in batches of some 20 ms, and sometimes late. The hand plays each of them
/// kDelay_s after its tick was due, with a cubic between two of them. If no wish is left, the hand stays at the last
/// one. After such a pause the hand plays up to 1.5 times as fast until the delay is kDelay_s again. So its position is
/// continuous.
class PlayedHand final : public Intention {
 public:
  /// A batch covers 20 ms; the other 30 ms are for the network and for stalls of a busy machine.
  static constexpr double kDelay_s = 0.05;
  /// If the newest tick is older than this, the hand releases its dead-man.
  static constexpr double kLongestSilence_s = 0.5;

  /// @param hand 0 left, 1 right. @pre start_W is within the device's reach.
  PlayedHand(const WorkspaceMap& map, std::size_t hand, const Vec3& start_W)
      : map_(map), hand_(hand), start_D_m_(map.to_device(start_W)) {}

  /// Adds new wishes, oldest first, and sets the speed of the play-back. @param t_s time since `started_at`; must not
  /// decrease from call to call, and later calls of at() must not ask for earlier times.
  void look(double t_s, Time started_at, std::span<const WishedTick> fresh);

  [[nodiscard]] Intent at(double t_s, const Touch&) const noexcept override { return at(t_s); }
  [[nodiscard]] Intent at(double t_s) const noexcept;
  [[nodiscard]] double end_s() const noexcept override { return end_s_; }
  [[nodiscard]] Vec3 start_D_m() const noexcept override { return start_D_m_; }

 private:
  static constexpr double kLongAgo_s = -1e300;

  struct Key {
    double t_s;  // time at which the tick was due, since the start
    Vec3 p_D, v_D;
    bool grip;
  };

  [[nodiscard]] double newest_s() const noexcept { return keys_.empty() ? kLongAgo_s : keys_.back().t_s; }
  [[nodiscard]] double played_s(double t_s) const noexcept;

  WorkspaceMap map_;
  std::size_t hand_;
  Vec3 start_D_m_;
  std::vector<Key> keys_;                                     // rising in time; at most the first is before the cursor
  double look_s_ = 0.0, cursor_s_ = kLongAgo_s, pace_ = 1.0;  // played_s(look_s_) is cursor_s_
  double end_s_ = kEndless_s;
};

}  // namespace ligature::sim
