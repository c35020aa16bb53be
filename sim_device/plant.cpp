#include "sim_device/plant.hpp"

#include <algorithm>

namespace ligature::sim {
namespace {

constexpr double kGravity_m_per_s2 = 9.81;

/// Inelastic end stop: the joint stays at the stop, and loses velocity that points outwards.
void stop(double& q, double& omega, double low, double high) noexcept {
  if (q < low) {
    q = low;
    omega = std::max(omega, 0.0);
  } else if (q > high) {
    q = high;
    omega = std::min(omega, 0.0);
  }
}

}  // namespace

void Plant::step(const Vec3& motor_Nm, const Vec3& hand_force_D_N, double dt_s) noexcept {
  const Vec3 outer_Nm = parameters_.linkage.jacobian_D(q_).transpose() * hand_force_D_N + gravity_Nm();
  for (int j = 0; j < 3; ++j) {
    const double motor = std::clamp(motor_Nm[j], -parameters_.max_torque_Nm, parameters_.max_torque_Nm);
    const double per_inertia = dt_s / parameters_.inertia_kg_m2[j];
    const double free =
        (omega_[j] + per_inertia * (motor + outer_Nm[j])) / (1.0 + per_inertia * parameters_.viscous_Nm_s[j]);
    const double dry = per_inertia * parameters_.coulomb_Nm[j];
    omega_[j] = std::copysign(std::max(std::abs(free) - dry, 0.0), free);
  }
  q_ += dt_s * omega_;
  stop_at_ends();
}

void Plant::stop_at_ends() noexcept {
  const Vec3 &low = parameters_.linkage.min_rad(), &high = parameters_.linkage.max_rad();
  stop(q_[0], omega_[0], low[0], high[0]);
  stop(q_[1], omega_[1], low[1], high[1]);
  if (!parameters_.linkage.is_serial()) return stop(q_[2], omega_[2], low[2], high[2]);
  const double angle = q_[2] - q_[1];
  const double clipped = std::clamp(angle, low[2], high[2]);
  if (angle == clipped) return;
  q_[2] = q_[1] + clipped;
  const double opening = omega_[2] - omega_[1];
  if ((angle > clipped) != (opening > 0.0)) return;  // the joint is already moving away from its stop
  // Inelastic impact between the two links: they share their angular momentum, so energy does not increase.
  const Vec3& inertia = parameters_.inertia_kg_m2;
  const double shared = (inertia[1] * omega_[1] + inertia[2] * omega_[2]) / (inertia[1] + inertia[2]);
  omega_[1] = omega_[2] = shared;
}

PlantParameters PlantParameters::of(const device::Device& device) {
  PlantParameters p;
  p.linkage = Linkage(device);
  const Vec3 lever_m = p.linkage.jacobian_D(p.linkage.joints(p.linkage.home_D_m()).value()).colwise().norm();
  p.inertia_kg_m2 = device.apparent_mass_kg * lever_m.cwiseAbs2();
  p.coulomb_Nm = device.coulomb_N * lever_m;
  p.viscous_Nm_s = device.damping_N_s_per_m * lever_m.cwiseAbs2();
  p.max_torque_Nm = device.max_torque_Nm();
  return p;
}

Vec3 Plant::gravity_Nm() const noexcept {
  const double g = kGravity_m_per_s2 * (1.0 - parameters_.gravity_compensation);
  return {0.0, -g * parameters_.upper_arm_kg_m * std::cos(q_[1]), -g * parameters_.forearm_kg_m * std::sin(q_[2])};
}

double Plant::potential_J() const noexcept {
  const double g = kGravity_m_per_s2 * (1.0 - parameters_.gravity_compensation);
  return g * (parameters_.upper_arm_kg_m * std::sin(q_[1]) - parameters_.forearm_kg_m * std::cos(q_[2]));
}

double Plant::kinetic_J() const noexcept { return 0.5 * parameters_.inertia_kg_m2.dot(omega_.cwiseAbs2()); }

}  // namespace ligature::sim
