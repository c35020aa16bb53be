#pragma once
// Mechanics of one device: three joints driven by motors and by a hand,
//   I_j dω_j/dt = τ_motor + (Jᵀ F_hand)_j + (1 − c) τ_gravity,j − b_j ω_j − τc_j sign(ω_j),   dq/dt = ω,
// within the joint stops. τ_gravity = −dV/dq with V = g (μ₂ sin q₂ − μ₃ cos q₃); μ is mass times lever of each link, c
// the fraction compensated by springs and counterweights. The inertia of the links is taken as constant and diagonal,
// about 45 g at the tip in the home pose. Coriolis terms are neglected (below 1 mN at hand speeds).

#include "sim_device/kinematics.hpp"

namespace ligature::sim {

struct PlantParameters {
  // An apparent mass of 45 g at the tip times the squared lever arms of the joints: 0.17 m (waist, home pose), 0.134 m,
  // 0.1325 m.
  Vec3 inertia_kg_m2{1.30e-3, 8.08e-4, 7.90e-4};
  // Friction of 0.1 N and 0.3 N s/m at the tip. This is below the 0.26 N that the Phantom Omni's data sheet allows,
  // because stability is harder to reach with less friction.
  Vec3 coulomb_Nm{0.0170, 0.0134, 0.0133};
  Vec3 viscous_Nm_s{8.7e-3, 5.4e-3, 5.3e-3};
  double max_torque_Nm = 0.9;  ///< 3000 per mille of 300 mN m
  // A weight of 45 g at each link's end. With a compensation of 0.8 about 0.1 N of it remain at the tip, which friction
  // can hold.
  double upper_arm_kg_m = 6.0e-3, forearm_kg_m = 6.0e-3;
  double gravity_compensation = 1.0;
  Linkage linkage{};  ///< includes the joint stops

  /// Joint inertias, friction and torques that match the record's values at the tip in the home pose. Weight is zero,
  /// because the record has none.
  [[nodiscard]] static PlantParameters of(const device::Device& device);
};

class Plant {
 public:
  explicit Plant(const Vec3& q_rad, const PlantParameters& parameters = {}) : parameters_(parameters), q_(q_rad) {}

  /// One step of dt_s (at most 0.1 ms). Semi-implicit Euler: velocity first, with implicit dry and viscous friction, so
  /// that friction cannot reverse a joint, and a joint at rest stays at rest below its Coulomb torque; then position;
  /// then stops.
  void step(const Vec3& motor_Nm, const Vec3& hand_force_D_N, double dt_s) noexcept;

  [[nodiscard]] const Vec3& q_rad() const noexcept { return q_; }
  [[nodiscard]] const Vec3& omega_rad_per_s() const noexcept { return omega_; }
  [[nodiscard]] Vec3 tip_D_m() const noexcept { return parameters_.linkage.tip_D_m(q_); }
  [[nodiscard]] Vec3 tip_velocity_D_m_per_s() const noexcept { return parameters_.linkage.jacobian_D(q_) * omega_; }
  [[nodiscard]] double kinetic_J() const noexcept;
  /// Potential energy of the uncompensated weight.
  [[nodiscard]] double potential_J() const noexcept;
  /// Joint torques of the uncompensated weight.
  [[nodiscard]] Vec3 gravity_Nm() const noexcept;
  [[nodiscard]] const PlantParameters& parameters() const noexcept { return parameters_; }

 private:
  void stop_at_ends() noexcept;

  PlantParameters parameters_;
  Vec3 q_;
  Vec3 omega_ = Vec3::Zero();
};

}  // namespace ligature::sim
