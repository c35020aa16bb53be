#pragma once
// Virtual coupling: spring and damper between a hand's device and the held thread.

#include "firmware/control/limits.hpp"
#include "firmware/physics/types.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::control {

/// The piece of thread that a hand holds, after the physics' last tick; world frame.
struct Grasp {
  bool held = false;
  physics::Vec3 p_WG = physics::Vec3::Zero();  ///< m
  physics::Vec3 v_WG = physics::Vec3::Zero();  ///< m/s
};

/// The tool as the physics sees it: a point without mass between the device and the held piece of thread.
struct Proxy {
  physics::Vec3 p_WP = physics::Vec3::Zero();
  physics::Vec3 v_WP = physics::Vec3::Zero();
};

/// Device T -- (K_d, B_d) -- proxy P -- (K_t, B_t) -- held node G (the 2007 paper, III.A.2: a spring and a damper on
/// each side), with positions p_T, p, p_G and velocities v_T, p', v_G. P has no mass, so both springs carry the same
/// force, and the hand feels the thread's force times s:
///   K_d (p_T - p) + B_d (v_T - p') + K_t (p_G - p) + B_t (v_G - p') = 0
///   p' = (p - p_before) / T                                                implicit Euler, so stable
///   f_device = s (K_d (p - p_T) + B_d (p' - v_T))
/// Without hands.device_N_per_m the device's side is rigid: P = T, f_device = s (K_t (p_G - p_T) + B_t (v_G - v_T)).
///   K_t, B_t  scene, world units, N/m and N s/m; s: force_scale, world newtons to device newtons
///   K_d, B_d  scene, at the device; in world units K_d / (s w), w = workspace_scale
/// Lengths scale by w, forces by s, time is not scaled. So at the device the thread's side has stiffness s w K_t and
/// damping s w B_t. O(1), no allocation. NaN in the inputs gives `finite` false and zero force.
class VirtualCoupling {
 public:
  VirtualCoupling(const scene::Hands& h, double period_s) noexcept;

  [[nodiscard]] double force_scale() const noexcept { return force_scale_; }
  void set_force_scale(double scale) noexcept { force_scale_ = scale; }

  struct Pull {
    physics::Vec3 f_N = physics::Vec3::Zero();  ///< force on the hand at the device, before gain and limits
    bool finite = true;
  };
  /// Advances the proxy by one period and returns the force.
  [[nodiscard]] Pull pull(const Grasp& grasp, const physics::Vec3& p_WT_m, const physics::Vec3& v_WT_m_per_s,
                          Proxy& proxy) const noexcept;

 private:
  void settle(const Grasp& grasp, const physics::Vec3& p_WT, const physics::Vec3& v_WT, Proxy& proxy) const noexcept;

  double thread_N_per_m_, thread_N_s_per_m_, device_N_per_m_, device_N_s_per_m_;
  bool rigid_;
  double force_scale_, workspace_scale_, period_s_;
};

}  // namespace ligature::control
