#pragma once
// The fingers: a spring and a damper without mass between where the operator wants to be and where the stylus is.
//   F_D = K (p_DH − p_DT) + B (v_DH − v_DT)
// H is the operator's intended point. Values are of a light stylus grip: stiff enough that the device follows within a
// millimetre, soft enough that the thread's pull is seen as motion (3.3 N moves the tip by 4 mm).

#include "sim_device/kinematics.hpp"

namespace ligature::sim {

struct Hand {
  double stiffness_N_per_m = 800.0;
  double damping_N_s_per_m = 8.0;

  [[nodiscard]] Vec3 force_on_tip_D_N(const Vec3& p_DH, const Vec3& v_DH, const Vec3& p_DT,
                                      const Vec3& v_DT) const noexcept {
    return stiffness_N_per_m * (p_DH - p_DT) + damping_N_s_per_m * (v_DH - v_DT);
  }
};

}  // namespace ligature::sim
