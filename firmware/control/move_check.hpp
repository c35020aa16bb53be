#pragma once
// Checks encoders by a guided move. Only in such a move does the rig know what each encoder must show, so the check
// also finds an encoder that was wrong from the start.

#include <algorithm>
#include <cmath>

#include "firmware/control/faults.hpp"
#include "firmware/control/kinematics.hpp"

namespace ligature::control {

/// Integrates the joint rates of the planned path, J^-1 v (J: Jacobian, v: velocity along the path), and compares the
/// result with what the encoders show. judge() is called when the tip strays from the path.
/// Reversed: a joint went kEnough counts or more against its commanded direction. (Somebody who pulls against the move
/// looks the same.)
/// Frozen: a joint that was commanded to go kEnough counts or more went at most kStill, while another joint went at
/// least the share kFollowed of its way. (A hand that holds the arm stops all joints, which is no fault.)
/// O(1), no allocation.
class MoveCheck {
 public:
  static constexpr double kEnough = 25.0, kStill = 2.5;  ///< counts
  static constexpr double kFollowed = 0.5;

  void start(const JointAngles& q_rad) noexcept {
    from_rad_ = vector_of(q_rad);
    asked_rad_ = Vec3::Zero();
  }
  void step(const Mat3& inverse_jacobian, const Vec3& v_m_per_s, double period_s) noexcept {
    const Vec3 dq = period_s * (inverse_jacobian * v_m_per_s);
    if (dq.allFinite()) asked_rad_ += dq;
  }
  [[nodiscard]] JointFault judge(const JointAngles& q_rad, double count_rad) const noexcept {
    const Vec3 went = vector_of(q_rad) - from_rad_;
    bool follows = false;
    JointFault frozen;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto j = static_cast<Eigen::Index>(k);
      const double enough_rad = kEnough * count_rad;
      if (went[j] * asked_rad_[j] < 0.0 && std::abs(went[j]) >= enough_rad)
        return fault_of_joint(Fault::kAxisReversed, k);
      if (std::abs(asked_rad_[j]) < enough_rad) continue;
      if (went[j] / asked_rad_[j] >= kFollowed) follows = true;
      if (frozen.joint < 0 && std::abs(went[j]) <= kStill * count_rad)
        frozen = fault_of_joint(Fault::kEncoderFrozen, k);
    }
    return follows ? frozen : JointFault{};
  }

 private:
  Vec3 from_rad_ = Vec3::Zero(), asked_rad_ = Vec3::Zero();
};

}  // namespace ligature::control
