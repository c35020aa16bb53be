#pragma once
// Geometry of the PHANTOM Omni-class linkage, derived here on its own: the controller has its own derivation, and a
// test that runs both against each other would see a mistake in either.
//
// The upper arm (l1) rises by q2 from the horizontal; the forearm (l2) hangs from its end and is turned by q3 out of
// the vertical. q3 is absolute: the parallelogram keeps the forearm's motor on the base. Both lie in a vertical plane
// that q1 turns about the base's z axis. In that plane, with r outwards and z up, the tip is
//   r = l1 cos q2 + l2 sin q3,   z = l1 sin q2 - l2 cos q3,   and in D   p_DT = (r sin q1, -r cos q1, z).

#include <Eigen/Core>
#include <cmath>
#include <optional>

namespace ligature::sim {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

inline constexpr double kUpperArm_m = 0.134;
inline constexpr double kForearm_m = 0.1325;

/// Tip position of a device at rest in the middle of its reach; the world's workspace_origin_m lies here.
[[nodiscard]] inline Vec3 home_tip_D_m() { return {0.0, -0.17, 0.0}; }

[[nodiscard]] inline Vec3 tip_D_m(const Vec3& q_rad) noexcept {
  const double r = kUpperArm_m * std::cos(q_rad[1]) + kForearm_m * std::sin(q_rad[2]);
  const double z = kUpperArm_m * std::sin(q_rad[1]) - kForearm_m * std::cos(q_rad[2]);
  return {r * std::sin(q_rad[0]), -r * std::cos(q_rad[0]), z};
}

/// Columns: velocity of the tip in D, m/s, for 1 rad/s of each joint. Joint torque of a tip force is J^T F.
[[nodiscard]] inline Mat3 tip_jacobian_D(const Vec3& q_rad) noexcept {
  const Vec3 outwards{std::sin(q_rad[0]), -std::cos(q_rad[0]), 0.0};
  const Vec3 sideways{std::cos(q_rad[0]), std::sin(q_rad[0]), 0.0};
  const double r = kUpperArm_m * std::cos(q_rad[1]) + kForearm_m * std::sin(q_rad[2]);
  Mat3 jacobian;
  jacobian.col(0) = r * sideways;
  jacobian.col(1) = kUpperArm_m * (Vec3::UnitZ() * std::cos(q_rad[1]) - outwards * std::sin(q_rad[1]));
  jacobian.col(2) = kForearm_m * (Vec3::UnitZ() * std::sin(q_rad[2]) + outwards * std::cos(q_rad[2]));
  return jacobian;
}

/// Joint angles of a tip position with the elbow up (the linkage cannot fold the other way); nothing when out of reach.
[[nodiscard]] inline std::optional<Vec3> joints_of_tip(const Vec3& p_DT) noexcept {
  const double r = std::hypot(p_DT.x(), p_DT.y());
  const double reach = std::hypot(r, p_DT.z());
  if (reach > kUpperArm_m + kForearm_m || reach < std::abs(kUpperArm_m - kForearm_m) + 1e-6) return std::nullopt;
  // Law of cosines: angle at the shoulder between the upper arm and the line to the tip.
  const double cosine =
      (kUpperArm_m * kUpperArm_m + reach * reach - kForearm_m * kForearm_m) / (2.0 * kUpperArm_m * reach);
  const double q2 = std::atan2(p_DT.z(), r) + std::acos(cosine);
  const double forearm_out = r - kUpperArm_m * std::cos(q2);
  const double forearm_down = kUpperArm_m * std::sin(q2) - p_DT.z();
  return Vec3{std::atan2(p_DT.x(), -p_DT.y()), q2, std::atan2(forearm_out, forearm_down)};
}

}  // namespace ligature::sim
