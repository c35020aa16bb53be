#include "firmware/control/virtual_coupling.hpp"

namespace ligature::control {

LimitedForce VirtualCoupling::force(const Grasp& grasp, const physics::Vec3& p_WT_m,
                                    const physics::Vec3& v_WT_m_per_s) const noexcept {
  if (!grasp.held) return {};
  const physics::Vec3 world_N = K_N_per_m_ * (grasp.p_WG - p_WT_m) + B_N_s_per_m_ * (grasp.v_WG - v_WT_m_per_s);
  return saturate(force_scale_ * world_N, max_force_N_);
}

}  // namespace ligature::control
