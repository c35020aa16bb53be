#pragma once
// Thermal limit of each joint's motor winding. Torque heats the winding, and the torque for a tip force depends on the
// pose.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "firmware/control/kinematics.hpp"
#include "firmware/control/thermal_cap.hpp"

namespace ligature::control {

/// Continuous torque limits of the joints, N m: the torques that the device's continuous tip force needs in the home
/// pose. The maker states that force for this pose.
[[nodiscard]] inline Vec3 continuous_torque_Nm(const device::Device& d) noexcept {
  return d.continuous_force_N * levers_at_home_m(d);
}

/// An I2t limit for each winding. When the arm is stretched further than in the home pose, the same tip force needs
/// more torque. Without these limits a winding could overheat although the tip's force is within its continuous limit,
/// and the drive would then cut the torque abruptly. O(1).
class Windings {
 public:
  Windings(const device::Device& d, double period_s) noexcept
      : caps_{cap_of(d, 0, period_s), cap_of(d, 1, period_s), cap_of(d, 2, period_s)} {}

  /// Largest factor by which these torques may be multiplied so that no winding exceeds its cap; infinite if no winding
  /// is limited.
  [[nodiscard]] double share(const Vec3& torque_Nm) const noexcept {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < caps_.size(); ++j) {
      const double size_Nm = std::abs(torque_Nm[static_cast<Eigen::Index>(j)]);
      if (!caps_[j].is_full() && size_Nm > 0.0) least = std::min(least, caps_[j].cap() / size_Nm);
    }
    return least;
  }
  /// Updates the windings' heat by the torques that are sent now. Call once per tick. @param periods since the last
  /// call.
  void sent(const Vec3& torque_Nm, std::int64_t periods = 1) noexcept {
    for (std::size_t j = 0; j < caps_.size(); ++j)
      caps_[j].sent(std::abs(torque_Nm[static_cast<Eigen::Index>(j)]), periods);
  }
  /// Temperature rise of the hottest winding, relative to that at continuous torque; at 1 its cap begins to fall.
  [[nodiscard]] double heat() const noexcept { return std::max({caps_[0].heat(), caps_[1].heat(), caps_[2].heat()}); }

 private:
  [[nodiscard]] static ThermalCap cap_of(const device::Device& d, Eigen::Index joint, double period_s) noexcept {
    const double continuous_Nm = continuous_torque_Nm(d)[joint];
    return {continuous_Nm * d.peak_force_N / d.continuous_force_N, continuous_Nm, d.thermal_time_s, period_s};
  }

  std::array<ThermalCap, 3> caps_;
};

}  // namespace ligature::control
