#pragma once
// Kinematics of the devices, derived independently of the firmware's: a test compares both, which reveals a mistake in
// either.
//
// Omni class: the upper arm (l1) rises by q2 from the horizontal; the forearm (l2) hangs from its end, turned by q3
// from the vertical. q3 is an absolute angle, because a parallelogram drives the forearm from the base. Both links lie
// in a vertical plane that q1 turns about the base's z axis. In that plane, with r outwards and z up, the tip is at
//   r = l1 cos q2 + l2 sin q3,   z = l1 sin q2 - l2 cos q3,   and in D   p_DT = (r sin q1, -r cos q1, z).
// Cartesian: three perpendicular axes, each moved by a drum of radius r_i:   p_DT,i = home_i + r_i q_i.

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "protocol/device/device.hpp"

namespace ligature::sim {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

/// Forward and inverse kinematics of a device, and its joint limits.
class Linkage {
 public:
  /// The shipped device.
  Linkage() : Linkage(device::omni()) {}
  explicit Linkage(const device::Device& d)
      : kind_(d.kinematics),
        links_m_(d.links_m.data()),
        home_m_(d.home_tip_m.data()),
        min_rad_(d.joint_min_rad.data()),
        max_rad_(d.joint_max_rad.data()) {}

  [[nodiscard]] bool is_serial() const noexcept { return kind_ == device::Kinematics::kOmniSerial; }
  /// Tip position in the home pose; it maps to the world's workspace_origin_m.
  [[nodiscard]] const Vec3& home_D_m() const noexcept { return home_m_; }
  /// Joint stops; for a serial linkage's third joint they limit the angle between the links, q3 - q2.
  [[nodiscard]] const Vec3& min_rad() const noexcept { return min_rad_; }
  [[nodiscard]] const Vec3& max_rad() const noexcept { return max_rad_; }

  [[nodiscard]] Vec3 tip_D_m(const Vec3& q) const noexcept {
    if (!is_serial()) return home_m_ + links_m_.cwiseProduct(q);
    const double r = links_m_[0] * std::cos(q[1]) + links_m_[1] * std::sin(q[2]);
    const double z = links_m_[0] * std::sin(q[1]) - links_m_[1] * std::cos(q[2]);
    return {r * std::sin(q[0]), -r * std::cos(q[0]), z};
  }

  /// Columns: velocity of the tip in D, m/s, at 1 rad/s of each joint. The joint torques of a tip force are J^T F.
  [[nodiscard]] Mat3 jacobian_D(const Vec3& q) const noexcept {
    if (!is_serial()) return links_m_.asDiagonal();
    const Vec3 outwards{std::sin(q[0]), -std::cos(q[0]), 0.0};
    const Vec3 sideways{std::cos(q[0]), std::sin(q[0]), 0.0};
    const double r = links_m_[0] * std::cos(q[1]) + links_m_[1] * std::sin(q[2]);
    Mat3 jacobian;
    jacobian.col(0) = r * sideways;
    jacobian.col(1) = links_m_[0] * (Vec3::UnitZ() * std::cos(q[1]) - outwards * std::sin(q[1]));
    jacobian.col(2) = links_m_[1] * (Vec3::UnitZ() * std::sin(q[2]) + outwards * std::cos(q[2]));
    return jacobian;
  }

  /// Joint coordinates of a tip position, of a serial arm those with the elbow up; nothing if the position is out of
  /// reach. Joint stops are not checked.
  [[nodiscard]] std::optional<Vec3> joints(const Vec3& p_DT) const noexcept {
    if (!is_serial()) return (p_DT - home_m_).cwiseQuotient(links_m_);
    const double l1 = links_m_[0], l2 = links_m_[1];
    const double r = std::hypot(p_DT.x(), p_DT.y());
    const double reach = std::hypot(r, p_DT.z());
    if (reach > l1 + l2 || reach < std::abs(l1 - l2) + 1e-6) return std::nullopt;
    // Law of cosines: angle at the shoulder between the upper arm and the line to the tip.
    const double cosine = (l1 * l1 + reach * reach - l2 * l2) / (2.0 * l1 * reach);
    const double q2 = std::atan2(p_DT.z(), r) + std::acos(cosine);
    const double forearm_out = r - l1 * std::cos(q2);
    const double forearm_down = l1 * std::sin(q2) - p_DT.z();
    return Vec3{std::atan2(p_DT.x(), -p_DT.y()), q2, std::atan2(forearm_out, forearm_down)};
  }

  [[nodiscard]] bool is_within_stops(const Vec3& q) const noexcept {
    const Vec3 bounded = is_serial() ? Vec3(q[0], q[1], q[2] - q[1]) : q;
    return (bounded.array() >= min_rad_.array()).all() && (bounded.array() <= max_rad_.array()).all();
  }
  /// Whether the tip can be at this position with every joint within its stops.
  [[nodiscard]] bool reaches(const Vec3& p_DT) const noexcept {
    const auto q = joints(p_DT);
    return q && is_within_stops(*q);
  }

 private:
  device::Kinematics kind_;
  Vec3 links_m_, home_m_, min_rad_, max_rad_;
};

}  // namespace ligature::sim
