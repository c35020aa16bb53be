#pragma once
// What the device may be asked for, whatever the law wants: one hand's limits, each with its code.

#include <cstdint>
#include <limits>

#include "firmware/control/limits.hpp"
#include "firmware/control/thermal_cap.hpp"
#include "firmware/rt/tick_record.hpp"
#include "protocol/device/device.hpp"

namespace ligature::control {

/// What the joints' torques allow in a wish's direction, N.
struct MostByJoints {
  double in_any_pose_N = std::numeric_limits<double>::infinity();
  double by_heat_N = std::numeric_limits<double>::infinity();
};

/// In this order, once a period of T:
///   peak        |f| <= min(scene's max_force_N, device's peak)
///   torque      |f| <= the most in f's direction that is within the peak in any pose of the arm (AnyPose)
///   continuous  |f| <= what is left of the peak by I2t (ThermalCap), of the force itself and of each joint's winding
///   step        |f - f_before| <= force_step_N in one period
///   slew        the same over many: an allowance refilled by force_slew_N_per_s T a period, at most force_step_N
/// The change keeps its direction, so every output lies between two that are allowed. O(1), no allocation.
class ForceLimiter {
 public:
  ForceLimiter(const device::Device& device, double max_force_N, double period_s) noexcept;

  void set_peak(double max_force_N) noexcept;

  /// @param wish_N finite. @return what may be sent; codes() says why it is less.
  [[nodiscard]] physics::Vec3 limit(const physics::Vec3& wish_N, const MostByJoints& most = {}) noexcept;
  /// What was sent after all (something may have cut it further): the next change and the heat start from it.
  /// @param periods since the last call
  void sent(const physics::Vec3& f_N, std::int64_t periods = 1) noexcept;

  [[nodiscard]] std::int16_t codes() const noexcept { return codes_; }  ///< rt::LimitCode bits of the last limit()
  [[nodiscard]] double heat() const noexcept { return thermal_.heat(); }
  [[nodiscard]] double peak_N() const noexcept { return peak_N_; }
  [[nodiscard]] double cap_N() const noexcept { return thermal_.cap(); }

 private:
  double device_peak_N_, step_N_, slew_N_per_s_, period_s_;
  double peak_N_ = 0.0, allowance_N_ = 0.0;
  ThermalCap thermal_;
  physics::Vec3 before_N_ = physics::Vec3::Zero();
  std::int16_t codes_ = 0;
};

}  // namespace ligature::control
