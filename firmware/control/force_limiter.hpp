#pragma once
// What the device may be asked for, whatever the law wants: one hand's limits, each with its code.

#include <cstdint>
#include <limits>

#include "firmware/control/limits.hpp"
#include "firmware/rt/tick_record.hpp"
#include "protocol/device/device.hpp"

namespace ligature::control {

/// In this order, once a period of T:
///   peak        |f| <= min(scene's max_force_N, device's peak)
///   torque      |f| <= the most in f's direction that is within the peak in any pose of the arm (AnyPose)
///   continuous  I2t: dh/dt = ((|f| / f_c)^2 - h) / tau; h is the winding's temperature rise, 1 = that of f_c for ever.
///               From h = 1 on the cap falls from the peak to f_c within kFall_s, below h = 0.7 it comes back as
///               slowly: with hysteresis, as a force that comes and goes is worse than one that is gone.
///   step        |f - f_before| <= force_step_N in one period
///   slew        the same over many: an allowance refilled by force_slew_N_per_s T a period, at most force_step_N
/// The change keeps its direction, so every output lies between two that are allowed. O(1), no allocation.
class ForceLimiter {
 public:
  static constexpr double kFall_s = 0.5;
  static constexpr double kHot = 1.0, kCool = 0.7;

  ForceLimiter(const device::Device& device, double max_force_N, double period_s) noexcept;

  void set_peak(double max_force_N) noexcept;

  /// @param wish_N finite. @param most_N by the joints' torques, in the wish's direction. @return what may be sent;
  /// codes() says why it is less.
  [[nodiscard]] physics::Vec3 limit(const physics::Vec3& wish_N,
                                    double most_N = std::numeric_limits<double>::infinity()) noexcept;
  /// What was sent after all (something may have cut it further): the next change and the heat start from it.
  void sent(const physics::Vec3& f_N) noexcept;

  [[nodiscard]] std::int16_t codes() const noexcept { return codes_; }  ///< rt::LimitCode bits of the last limit()
  [[nodiscard]] double heat() const noexcept { return heat_; }
  [[nodiscard]] double peak_N() const noexcept { return peak_N_; }
  [[nodiscard]] double cap_N() const noexcept { return cap_N_; }

 private:
  void move_cap() noexcept;

  double device_peak_N_, continuous_N_, tau_s_, step_N_, slew_N_per_s_, period_s_;
  double peak_N_ = 0.0, cap_N_ = 0.0, heat_ = 0.0, allowance_N_ = 0.0;
  bool hot_ = false;
  physics::Vec3 before_N_ = physics::Vec3::Zero();
  std::int16_t codes_ = 0;
};

}  // namespace ligature::control
