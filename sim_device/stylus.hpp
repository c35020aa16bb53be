#pragma once
// Elastic links: a spring and damper between the point L computed from the joints and the point T that the fingers
// hold. x is the position of T in the device's base frame D, m the mass of the tip, F the force on the linkage, k and b
// stiffness and damping of the links:
//   m ẍ = F_hand − F,   F = k (x − p_DL) + b (ẋ − v_DL),   with a different k for each axis

#include "sim_device/kinematics.hpp"

namespace ligature::sim {

struct Compliance {
  double tip_mass_kg = 0.0;                        ///< 0: rigid links, T = L
  Vec3 stiffness_N_per_m{1260.0, 2310.0, 1020.0};  ///< x, y, z: data sheet of the device class, as lower bounds
  /// Assumed: some per cent of critical damping, as for metal and plastic
  double damping_N_s_per_m = 0.5;

  /// Elastic links with 10 g of stylus and gimbal beyond the spring (assumed).
  [[nodiscard]] static Compliance of_the_class() noexcept {
    Compliance c;
    c.tip_mass_kg = 0.010;
    return c;
  }
};

class Stylus {
 public:
  Stylus(const Compliance& compliance, const Vec3& p_D) : compliance_(compliance), p_D_(p_D) {}

  [[nodiscard]] bool is_rigid() const noexcept { return compliance_.tip_mass_kg <= 0.0; }

  /// @return force on the linkage, N, before the step; then advances the tip's mass by dt_s.
  Vec3 step(const Vec3& hand_D_N, const Vec3& p_DL, const Vec3& v_DL, double dt_s) noexcept {
    if (is_rigid()) return hand_D_N;
    Vec3 bend = compliance_.stiffness_N_per_m.cwiseProduct(p_D_ - p_DL) + compliance_.damping_N_s_per_m * (v_D_ - v_DL);
    v_D_ += dt_s / compliance_.tip_mass_kg * (hand_D_N - bend);
    p_D_ += dt_s * v_D_;
    return bend;
  }
  [[nodiscard]] const Vec3& position_D_m() const noexcept { return p_D_; }
  [[nodiscard]] const Vec3& velocity_D_m_per_s() const noexcept { return v_D_; }

 private:
  Compliance compliance_;
  Vec3 p_D_;
  Vec3 v_D_ = Vec3::Zero();
};

}  // namespace ligature::sim
