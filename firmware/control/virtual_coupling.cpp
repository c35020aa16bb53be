#include "firmware/control/virtual_coupling.hpp"

namespace ligature::control {

using physics::Vec3;

VirtualCoupling::VirtualCoupling(const scene::Hands& h, double period_s) noexcept
    : thread_N_per_m_(h.coupling_N_per_m),
      thread_N_s_per_m_(h.coupling_N_s_per_m),
      device_N_per_m_(h.device_N_per_m.value_or(0.0)),
      device_N_s_per_m_(h.device_N_s_per_m),
      rigid_(!h.device_N_per_m.has_value()),
      force_scale_(h.force_scale),
      workspace_scale_(h.workspace_scale),
      period_s_(period_s) {}

void VirtualCoupling::settle(const Grasp& grasp, const Vec3& p_WT, const Vec3& v_WT, Proxy& proxy) const noexcept {
  const double to_world = 1.0 / (force_scale_ * workspace_scale_);
  const double Kd = device_N_per_m_ * to_world, Bd = device_N_s_per_m_ * to_world;
  const double per_T = (Bd + thread_N_s_per_m_) / period_s_;
  const Vec3 pulls = Kd * p_WT + Bd * v_WT + thread_N_per_m_ * grasp.p_WG + thread_N_s_per_m_ * grasp.v_WG;
  const Vec3 before = proxy.p_WP;
  proxy.p_WP = (pulls + per_T * before) / (Kd + thread_N_per_m_ + per_T);
  proxy.v_WP = (proxy.p_WP - before) / period_s_;
}

VirtualCoupling::Pull VirtualCoupling::pull(const Grasp& grasp, const Vec3& p_WT, const Vec3& v_WT,
                                            Proxy& proxy) const noexcept {
  if (!grasp.held || rigid_ || force_scale_ <= 0.0) {
    proxy = {p_WT, v_WT};
    if (!grasp.held) return {};
    const Vec3 world_N = thread_N_per_m_ * (grasp.p_WG - p_WT) + thread_N_s_per_m_ * (grasp.v_WG - v_WT);
    const Vec3 f_N = force_scale_ * world_N;
    return f_N.allFinite() ? Pull{f_N, true} : Pull{Vec3::Zero(), false};
  }
  const Proxy before = proxy;
  settle(grasp, p_WT, v_WT, proxy);
  const Vec3 f_N = (device_N_per_m_ * (proxy.p_WP - p_WT) + device_N_s_per_m_ * (proxy.v_WP - v_WT)) / workspace_scale_;
  if (f_N.allFinite()) return {f_N, true};
  proxy = before;
  return {Vec3::Zero(), false};
}

}  // namespace ligature::control
