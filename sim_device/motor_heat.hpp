#pragma once
// Thermal model of a motor, and its drive's protection. h is the winding's temperature rise divided by its limit, τ the
// torque:
//   dh/dt = ((τ / τ_continuous)² − h) / time constant
// From h = 1 on the drive limits the torque to τ_continuous until h has fallen below 0.95 (I²t with hysteresis).

#include <algorithm>
#include <array>

#include "sim_device/kinematics.hpp"

namespace ligature::sim {

struct MotorRating {
  // A continuous force of 0.88 N at the tip times the lever arms of the joints: 0.17 m (waist, home pose), 0.134 m,
  // 0.1325 m.
  Vec3 continuous_Nm{0.150, 0.118, 0.117};
  double time_constant_s = 20.0;  ///< assumed: small motors in a closed housing
};

class MotorHeat {
 public:
  explicit MotorHeat(const MotorRating& rating = {}) : rating_(rating) {}

  /// The torque that the drives let through for dt_s if `wanted_Nm` is commanded; heats the windings.
  Vec3 pass(const Vec3& wanted_Nm, double dt_s) noexcept {
    Vec3 passed = wanted_Nm;
    for (Eigen::Index j = 0; j < 3; ++j) {
      auto& held = held_[static_cast<std::size_t>(j)];
      const double most = rating_.continuous_Nm[j];
      if (heat_[j] >= 1.0) held = true;
      if (heat_[j] < 0.95) held = false;
      if (held) passed[j] = std::clamp(passed[j], -most, most);
      const double load = passed[j] / most;
      heat_[j] += dt_s / rating_.time_constant_s * (load * load - heat_[j]);
    }
    return passed;
  }
  [[nodiscard]] const Vec3& heat() const noexcept { return heat_; }
  [[nodiscard]] bool is_holding(Eigen::Index joint) const noexcept { return held_[static_cast<std::size_t>(joint)]; }
  [[nodiscard]] bool is_holding() const noexcept { return held_[0] || held_[1] || held_[2]; }

 private:
  MotorRating rating_;
  Vec3 heat_ = Vec3::Zero();
  std::array<bool, 3> held_{};
};

}  // namespace ligature::sim
