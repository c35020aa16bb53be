#pragma once
// Virtual coupling: springs and dampers between a hand's device and the held piece of thread.

#include "firmware/control/limits.hpp"
#include "firmware/physics/types.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::control {

/// The piece of thread that a hand holds, as the last tick of the physics left it; in the world frame.
struct Grasp {
  bool held = false;
  physics::Vec3 p_WG = physics::Vec3::Zero();  ///< m
  physics::Vec3 v_WG = physics::Vec3::Zero();  ///< m/s
};

/// The proxy: a point without mass between the device and the held piece of thread. The physics sees the proxy as the
/// tool.
struct Proxy {
  physics::Vec3 p_WP = physics::Vec3::Zero();
  physics::Vec3 v_WP = physics::Vec3::Zero();
};

/// The coupling of the 2007 paper (III.A.2), with a spring K and a damper B on each side of a proxy:
///   device T -- (K_d, B_d) -- proxy P -- (K_t, B_t) -- held node G
/// Positions are p_T, p, p_G, velocities v_T, p', v_G. The proxy has no mass, so the forces on it balance. The hand
/// feels the thread's force times s:
///   K_d (p_T - p) + B_d (v_T - p') + K_t (p_G - p) + B_t (v_G - p') = 0
///   p' = (p - p_before) / T                                                implicit Euler with the period T, so stable
///   f_device = s (K_d (p - p_T) + B_d (p' - v_T))
/// Without hands.device_N_per_m the device's side is rigid: P = T, f_device = s (K_t (p_G - p_T) + B_t (v_G - v_T)).
///   K_t, B_t  from the scene, in world units, N/m and N s/m
///   K_d, B_d  from the scene at the device; here in world units, that is divided by s w
///   s, w      force_scale (world newtons to device newtons) and workspace_scale (device metres to world metres)
/// At the device, the thread's side thus has stiffness s w K_t and damping s w B_t. O(1), no allocation. NaN in the
/// inputs gives `finite` false and zero force.
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
