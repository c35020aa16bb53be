#include "sim_device/operator/hands.hpp"

#include <algorithm>

namespace ligature::sim {

void MovingHand::rest_at(const Vec3& start_W, double speed_m_per_s) {
  goal_W = p_W_ = start_W;
  v_W_ = Vec3::Zero();
  speed_m_per_s_ = speed_m_per_s;
  for (std::size_t k = 0; k < 3; ++k) in_.current_position[k] = start_W[static_cast<Eigen::Index>(k)];
}

void MovingHand::tick() {
  const double speed = speed_m_per_s_ * std::clamp(pace, 0.01, 4.0),
               acceleration = (is_wary ? 4.0 : 1.0) * speed_m_per_s_ / 0.15;
  for (std::size_t k = 0; k < 3; ++k) {
    in_.target_position[k] = goal_W[static_cast<Eigen::Index>(k)];
    in_.max_velocity[k] = speed;
    in_.max_acceleration[k] = acceleration;
    in_.max_jerk[k] = acceleration / 0.05;
  }
  if (!goal_W.allFinite() || planner_.update(in_, out_) < 0) return;
  out_.pass_to_input(in_);
  for (std::size_t k = 0; k < 3; ++k) {
    p_W_[static_cast<Eigen::Index>(k)] = out_.new_position[k];
    v_W_[static_cast<Eigen::Index>(k)] = out_.new_velocity[k];
  }
}

}  // namespace ligature::sim
