#include "firmware/control/kinematics.hpp"

#include <cmath>

namespace ligature::control {

Vec3 tip_position(const JointAngles& q_rad) noexcept {
  const auto [q1, q2, q3] = q_rad;
  const double rho = kUpperArm_m * std::cos(q2) + kForearm_m * std::sin(q3);
  return {rho * std::sin(q1), -rho * std::cos(q1), kUpperArm_m * std::sin(q2) - kForearm_m * std::cos(q3)};
}

Mat3 tip_jacobian(const JointAngles& q_rad) noexcept {
  const auto [q1, q2, q3] = q_rad;
  const double s1 = std::sin(q1), c1 = std::cos(q1);
  const double rho = kUpperArm_m * std::cos(q2) + kForearm_m * std::sin(q3);
  const double drho_dq2 = -kUpperArm_m * std::sin(q2);
  const double drho_dq3 = kForearm_m * std::cos(q3);
  Mat3 J;
  J << rho * c1, drho_dq2 * s1, drho_dq3 * s1,   //
      rho * s1, -drho_dq2 * c1, -drho_dq3 * c1,  //
      0.0, kUpperArm_m * std::cos(q2), kForearm_m * std::sin(q3);
  return J;
}

Vec3 joint_torque(const JointAngles& q_rad, const Vec3& f_D_N) noexcept {
  return tip_jacobian(q_rad).transpose() * f_D_N;
}

bool is_plausible(const JointAngles& q_rad) noexcept {
  const auto within = [](double x, double low, double high) { return x >= low - 0.25 && x <= high + 0.25; };
  return within(q_rad[0], -0.98, 0.98) && within(q_rad[1], 0.0, 1.75) && within(q_rad[2] - q_rad[1], -0.81, 1.25);
}

}  // namespace ligature::control
