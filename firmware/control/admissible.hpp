#pragma once
// The largest coupling stiffness that a device can render stably.

#include "protocol/device/device.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::control {

/// The coupling as the device feels it while the thread does not yield (stiffness K, damping B), and the limit below
/// which it is stable:
///   K < (b + B) / (T/2 + t_d)      b: damping of the device, T: period, t_d: delay from sample to torque
/// The limit holds for a sampled, delayed spring with small B (Gil; Hulin et al., IEEE Trans. Control Syst. Technol.
/// 2014). A hand that holds the device only adds damping.
/// If the scene has a spring on the device's side (K_d, B_d), it is in series with the one on the thread's side (K_t,
/// B_t: the scene's values times force scale and workspace scale):
///   K = K_d K_t / (K_d + K_t),   B = (B_d K_t^2 + B_t K_d^2) / (K_d + K_t)^2     (at low frequencies)
struct Admissible {
  double K_N_per_m = 0.0;
  double B_N_s_per_m = 0.0;
  double largest_N_per_m = 0.0;  ///< stability limit of K

  [[nodiscard]] bool holds() const noexcept { return K_N_per_m < largest_N_per_m; }
};

[[nodiscard]] inline Admissible admissible(const scene::Hands& h, const device::Device& d, double period_s) noexcept {
  const double to_device = h.force_scale * h.workspace_scale;
  const double Kt = to_device * h.coupling_N_per_m, Bt = to_device * h.coupling_N_s_per_m;
  Admissible a{Kt, Bt, 0.0};
  if (h.device_N_per_m && Kt > 0.0) {
    const double Kd = *h.device_N_per_m, sum = Kd + Kt;
    a.K_N_per_m = Kd * Kt / sum;
    a.B_N_s_per_m = (h.device_N_s_per_m * Kt * Kt + Bt * Kd * Kd) / (sum * sum);
  }
  a.largest_N_per_m = (d.damping_N_s_per_m + a.B_N_s_per_m) / (0.5 * period_s + d.delay_s);
  return a;
}

}  // namespace ligature::control
