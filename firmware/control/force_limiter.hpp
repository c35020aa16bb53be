#pragma once
// Limits of one hand's force: peak, torque, heat, step and slew rate. Each limit has a code, by which it is reported
// when it acts.

#include <cstdint>
#include <limits>

#include "firmware/control/limits.hpp"
#include "firmware/control/thermal_cap.hpp"
#include "firmware/rt/tick_record.hpp"
#include "protocol/device/device.hpp"

namespace ligature::control {

/// Two upper bounds, N, for a force in the requested direction. Above in_any_pose_N, its joint torques could make more
/// than the peak force in some pose. Above by_heat_N, they could overheat a motor winding.
struct MostByJoints {
  double in_any_pose_N = std::numeric_limits<double>::infinity();
  double by_heat_N = std::numeric_limits<double>::infinity();
};

/// Limits on the force f, applied in this order once per period T. f_before is the force of the period before.
///   peak        |f| <= the smaller of the scene's max_force_N and the device's peak
///   torque      |f| <= the largest force in f's direction whose torques stay within the peak in any pose (AnyPose)
///   continuous  |f| <= the peak as reduced by heat (ThermalCap), for the force itself and for each joint's winding
///   step        |f - f_before| <= force_step_N
///   slew        |f - f_before| <= an allowance, which each change uses up by its size, and which grows by
///               force_slew_N_per_s T per period up to force_step_N
/// The change f - f_before keeps its direction, so each output lies between two allowed forces. O(1), no allocation.
class ForceLimiter {
 public:
  ForceLimiter(const device::Device& device, double max_force_N, double period_s) noexcept;

  void set_peak(double max_force_N) noexcept;

  /// @param wish_N requested force, finite. @return the force that may be sent; codes() tells which limits reduced it.
  [[nodiscard]] physics::Vec3 limit(const physics::Vec3& wish_N, const MostByJoints& most = {}) noexcept;
  /// Tells the limiter which force was sent in the end (later stages may reduce it). The next change and the heat are
  /// computed from this force.
  /// @param periods since the last call
  void sent(const physics::Vec3& f_N, std::int64_t periods = 1) noexcept;

  /// rt::LimitCode bits of the last limit()
  [[nodiscard]] std::int16_t codes() const noexcept { return static_cast<std::int16_t>(codes_); }
  [[nodiscard]] double heat() const noexcept { return thermal_.heat(); }
  [[nodiscard]] double peak_N() const noexcept { return peak_N_; }
  [[nodiscard]] double cap_N() const noexcept { return thermal_.cap(); }

 private:
  double device_peak_N_, step_N_, slew_N_per_s_, period_s_;
  double peak_N_ = 0.0, allowance_N_ = 0.0;
  ThermalCap thermal_;
  physics::Vec3 before_N_ = physics::Vec3::Zero();
  int codes_ = 0;
};

}  // namespace ligature::control
