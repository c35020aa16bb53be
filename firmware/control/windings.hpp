#pragma once
// The motors' windings, joint by joint: what warms them is torque, wherever the tip is.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "firmware/control/kinematics.hpp"
#include "firmware/control/thermal_cap.hpp"

namespace ligature::control {

/// The torques that the record's continuous force makes at home, where its maker states it. N m.
[[nodiscard]] inline Vec3 continuous_torque_Nm(const device::Device& d) noexcept {
  return d.continuous_force_N * levers_at_home_m(d);
}

/// An arm that reaches further than home needs more torque for the same force: a winding gets hot, and its drive holds
/// it down by a jump, while the tip's force is what may be made for ever. So each winding has its own I2t. O(1).
class Windings {
 public:
  Windings(const device::Device& d, double period_s) noexcept
      : caps_{cap_of(d, 0, period_s), cap_of(d, 1, period_s), cap_of(d, 2, period_s)} {}

  /// Times these torques are what all windings may have now. Where none is warm: without a limit.
  [[nodiscard]] double share(const Vec3& torque_Nm) const noexcept {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < caps_.size(); ++j) {
      const double size_Nm = std::abs(torque_Nm[static_cast<Eigen::Index>(j)]);
      if (!caps_[j].is_full() && size_Nm > 0.0) least = std::min(least, caps_[j].cap() / size_Nm);
    }
    return least;
  }
  /// Once a tick. @param periods since the last call.
  void sent(const Vec3& torque_Nm, std::int64_t periods = 1) noexcept {
    for (std::size_t j = 0; j < caps_.size(); ++j)
      caps_[j].sent(std::abs(torque_Nm[static_cast<Eigen::Index>(j)]), periods);
  }
  /// Of the hottest: 1 = its cap begins to fall.
  [[nodiscard]] double heat() const noexcept { return std::max({caps_[0].heat(), caps_[1].heat(), caps_[2].heat()}); }

 private:
  [[nodiscard]] static ThermalCap cap_of(const device::Device& d, Eigen::Index joint, double period_s) noexcept {
    const double continuous_Nm = continuous_torque_Nm(d)[joint];
    return {continuous_Nm * d.peak_force_N / d.continuous_force_N, continuous_Nm, d.thermal_time_s, period_s};
  }

  std::array<ThermalCap, 3> caps_;
};

}  // namespace ligature::control
