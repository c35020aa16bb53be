#pragma once
// The spring and damper between a tool and the node it holds, as the hand feels it.

#include "firmware/control/limits.hpp"
#include "firmware/physics/types.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::control {

/// The node a hand holds, as the thread's last tick left it; world frame.
struct Grasp {
  bool held = false;
  physics::Vec3 p_WG = physics::Vec3::Zero();  ///< m
  physics::Vec3 v_WG = physics::Vec3::Zero();  ///< m/s
};

/// f = sat(s (K (p_WG - p_WT) + B (v_WG - v_WT)), f_max) for a held node, else 0: towards the node.
///   K, B: coupling in world units, N/m and N s/m;  s: force_scale, world newtons to device newtons;
///   f_max: max_force_N, by magnitude, so that a limited force keeps its direction.
/// O(1), no allocation. Not-a-number in gives `finite` false and zero force.
class VirtualCoupling {
 public:
  explicit VirtualCoupling(const scene::Hands& h) noexcept
      : K_N_per_m_(h.coupling_N_per_m),
        B_N_s_per_m_(h.coupling_N_s_per_m),
        force_scale_(h.force_scale),
        max_force_N_(h.max_force_N) {}

  [[nodiscard]] double force_scale() const noexcept { return force_scale_; }
  void set_force_scale(double scale) noexcept { force_scale_ = scale; }

  [[nodiscard]] LimitedForce force(const Grasp& grasp, const physics::Vec3& p_WT_m,
                                   const physics::Vec3& v_WT_m_per_s) const noexcept;

 private:
  double K_N_per_m_, B_N_s_per_m_, force_scale_, max_force_N_;
};

}  // namespace ligature::control
