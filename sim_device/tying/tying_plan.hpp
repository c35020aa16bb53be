#pragma once
// A simulated operator that sees only the rig's LCM messages: LIGATURE_THREAD and LIGATURE_TICKS in, planned positions
// of both hands out.

#include <optional>
#include <vector>

#include "ligature_msg/thread_t.hpp"
#include "ligature_msg/tick_batch_t.hpp"
#include "sim_device/operator/knot_tier.hpp"
#include "sim_device/tying/played_hand.hpp"

namespace ligature::sim {

/// A pure function of the messages and their order: two processes that receive the same messages plan the same, bit by
/// bit, and each moves one of the hands. The time of the plan is the tick number. The plan begins with the first tick
/// in which both hands have full force. Messages of later runs of the firmware (other sessions) are ignored. A message
/// that contains NaN or infinity is ignored, too. During lost ticks the plan continues with what it saw last.
class TyingPlan {
 public:
  /// Lost ticks in a row through which the plan continues; during further ones it waits.
  static constexpr std::int64_t kMostBlind = 1000;

  TyingPlan(KnotTier tier, const scene::Scene& scene) : tier_(std::move(tier)), force_scale_(scene.hands.force_scale) {}

  void take(const ligature_msg::thread_t& thread);
  /// @param wishes receives one entry for each tick of the batch
  void take(const ligature_msg::tick_batch_t& batch, std::vector<WishedTick>& wishes);

  [[nodiscard]] const KnotTier& tier() const noexcept { return tier_; }
  [[nodiscard]] std::int64_t lost_ticks() const noexcept { return lost_; }

 private:
  void feel(const ligature_msg::tick_t& tick);
  void pass_blindly(std::int64_t ticks);

  KnotTier tier_;
  double force_scale_;
  std::vector<Vec3> thread_W_;
  Sight sight_;
  std::optional<std::int64_t> session_;
  bool has_begun_ = false;
  std::int64_t last_tick_ = -1, lost_ = 0;
};

}  // namespace ligature::sim
