#include "firmware/control/kinematics.hpp"

#include <cmath>

namespace ligature::control {
namespace {

constexpr double kPlausible_rad = 0.25;

Vec3 omni_position(const Vec3& l, const JointAngles& q_rad) noexcept {
  const auto [q1, q2, q3] = q_rad;
  const double rho = l[0] * std::cos(q2) + l[1] * std::sin(q3);
  return {rho * std::sin(q1), -rho * std::cos(q1), l[0] * std::sin(q2) - l[1] * std::cos(q3)};
}

Mat3 omni_jacobian(const Vec3& l, const JointAngles& q_rad) noexcept {
  const auto [q1, q2, q3] = q_rad;
  const double s1 = std::sin(q1), c1 = std::cos(q1);
  const double rho = l[0] * std::cos(q2) + l[1] * std::sin(q3);
  const double drho_dq2 = -l[0] * std::sin(q2);
  const double drho_dq3 = l[1] * std::cos(q3);
  Mat3 J;
  J << rho * c1, drho_dq2 * s1, drho_dq3 * s1,   //
      rho * s1, -drho_dq2 * c1, -drho_dq3 * c1,  //
      0.0, l[0] * std::cos(q2), l[1] * std::sin(q3);
  return J;
}

}  // namespace

Vec3 levers_at_home_m(const device::Device& d) noexcept {
  Vec3 levers_m = vector_of(d.links_m);
  if (d.kinematics == device::Kinematics::kOmniSerial)
    levers_m = Vec3(std::hypot(d.home_tip_m[0], d.home_tip_m[1]), d.links_m[0], d.links_m[1]);
  return levers_m;
}

Linkage::Linkage(const device::Device& d) noexcept
    : kind_(d.kinematics),
      links_m_(vector_of(d.links_m)),
      home_m_(vector_of(d.home_tip_m)),
      min_rad_(d.joint_min_rad),
      max_rad_(d.joint_max_rad) {}

Vec3 Linkage::position(const JointAngles& q_rad) const noexcept {
  if (kind_ == device::Kinematics::kOmniSerial) return omni_position(links_m_, q_rad);
  return home_m_ + links_m_.cwiseProduct(vector_of(q_rad));
}

Mat3 Linkage::jacobian(const JointAngles& q_rad) const noexcept {
  if (kind_ == device::Kinematics::kOmniSerial) return omni_jacobian(links_m_, q_rad);
  return links_m_.asDiagonal();
}

std::array<bool, 3> Linkage::far_from_stops(const JointAngles& q_rad) const noexcept {
  constexpr double kFar_rad = 0.05;
  JointAngles stop = q_rad;
  if (kind_ == device::Kinematics::kOmniSerial) stop[2] -= q_rad[1];
  std::array<bool, 3> far{};
  for (std::size_t j = 0; j < far.size(); ++j)
    far[j] = stop[j] > min_rad_[j] + kFar_rad && stop[j] < max_rad_[j] - kFar_rad;
  // The stop between the links limits both joints
  if (kind_ == device::Kinematics::kOmniSerial) far[1] = far[1] && far[2];
  return far;
}

bool Linkage::is_plausible(const JointAngles& q_rad) const noexcept {
  JointAngles stop = q_rad;
  if (kind_ == device::Kinematics::kOmniSerial) stop[2] -= q_rad[1];  // the stop limits the angle between the links
  for (std::size_t j = 0; j < stop.size(); ++j) {
    const bool within = stop[j] >= min_rad_[j] - kPlausible_rad && stop[j] <= max_rad_[j] + kPlausible_rad;
    if (!within) return false;  // also for NaN
  }
  return true;
}

}  // namespace ligature::control
