#pragma once
// The spring and damper between a hand's device and the thread it holds, as the hand feels them.

#include "firmware/control/limits.hpp"
#include "firmware/physics/types.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::control {

/// What a hand holds of the thread, as its last tick left it; world frame.
struct Grasp {
  bool held = false;
  physics::Vec3 p_WG = physics::Vec3::Zero();  ///< m
  physics::Vec3 v_WG = physics::Vec3::Zero();  ///< m/s
};

/// The tool as the thread feels it: a point without mass between the device and what is held.
struct Proxy {
  physics::Vec3 p_WP = physics::Vec3::Zero();
  physics::Vec3 v_WP = physics::Vec3::Zero();
};

/// Device T -- (K_d, B_d) -- proxy P -- (K_t, B_t) -- held node G (the paper, III.A.2: one pair of constants a side).
/// P has no mass, so both springs carry the same force, and the hand feels what the thread feels, scaled:
///   K_d (p_T - p) + B_d (v_T - p') + K_t (p_G - p) + B_t (v_G - p') = 0
///   p' = (p - p_before) / T                                                implicit, so stable
///   f_device = s (K_d (p - p_T) + B_d (p' - v_T))
/// Without hands.device_N_per_m the device's side is rigid: P = T, f_device = s (K_t (p_G - p_T) + B_t (v_G - v_T)).
///   K_t, B_t  scene, world units, N/m and N s/m; s: force_scale, world newtons to device newtons
///   K_d, B_d  scene, at the device; in world units K_d / (s w), w = workspace_scale
/// Lengths scale by w, forces by s, time not at all, so stiffness and damping scale alike: at the device the thread's
/// side is s w K_t and s w B_t.
/// O(1), no allocation. Not-a-number in gives `finite` false and zero force.
class VirtualCoupling {
 public:
  VirtualCoupling(const scene::Hands& h, double period_s) noexcept;

  [[nodiscard]] double force_scale() const noexcept { return force_scale_; }
  void set_force_scale(double scale) noexcept { force_scale_ = scale; }

  struct Pull {
    physics::Vec3 f_N = physics::Vec3::Zero();  ///< on the hand, at the device, before every limit
    bool finite = true;
  };
  /// One period on: moves the proxy.
  [[nodiscard]] Pull pull(const Grasp& grasp, const physics::Vec3& p_WT_m, const physics::Vec3& v_WT_m_per_s,
                          Proxy& proxy) const noexcept;

 private:
  void settle(const Grasp& grasp, const physics::Vec3& p_WT, const physics::Vec3& v_WT, Proxy& proxy) const noexcept;

  double thread_N_per_m_, thread_N_s_per_m_, device_N_per_m_, device_N_s_per_m_;
  bool rigid_;
  double force_scale_, workspace_scale_, period_s_;
};

}  // namespace ligature::control
