#pragma once
// Two hands that move smoothly towards goals set by the operator.

#include <array>
#include <ruckig/ruckig.hpp>

#include "sim_device/operator/sight.hpp"

namespace ligature::sim {

/// One hand: follows a goal that may change at any time, with limited speed, acceleration and jerk (ruckig, online).
class MovingHand {
 public:
  explicit MovingHand(double tick_s) : planner_(tick_s) {}

  /// Places the hand at rest. @param speed_m_per_s full speed of the moves that follow; a move's `pace` multiplies it.
  /// Full speed is reached within 0.15 s, full acceleration within 0.05 s.
  void rest_at(const Vec3& start_W, double speed_m_per_s);

  Vec3 goal_W = Vec3::Zero();
  double pace = 1.0;     ///< factor on the full speed
  bool is_wary = false;  ///< the hand feels a high pull: acceleration and braking are four times as fast
  bool grip = false;

  /// Advances by one tick. If ruckig refuses the goal (not finite), the hand stays where it is.
  void tick();

  [[nodiscard]] const Vec3& p_W() const noexcept { return p_W_; }
  [[nodiscard]] const Vec3& v_W() const noexcept { return v_W_; }
  [[nodiscard]] double to_go_m() const noexcept { return (goal_W - p_W_).norm(); }

 private:
  ruckig::Ruckig<3> planner_;
  ruckig::InputParameter<3> in_{};
  ruckig::OutputParameter<3> out_;
  double speed_m_per_s_ = 0.1;
  Vec3 p_W_ = Vec3::Zero(), v_W_ = Vec3::Zero();
};

}  // namespace ligature::sim
