#pragma once

#include "firmware/physics/v3.hpp"

namespace ligature::physics {

/// Slip velocity of a contact: v_r without its normal part, m/s.
inline V3<double> slip_velocity(const V3<double>& v_relative, const V3<double>& normal) noexcept {
  return v_relative - dot(v_relative, normal) * normal;
}

/// Coulomb friction, the paper's equations (1) and (3): f_f = mu |n| e^ on the first body, N. e^ is the unit vector
/// against the slip, n the normal force. As printed in the paper it is 0/0 at zero slip (here: zero), and unlimited: at
/// mu = 10 it reverses the slip within one step.
inline V3<double> coulomb_friction_N(double mu, double normal_N, const V3<double>& v_relative,
                                     const V3<double>& normal) noexcept {
  const V3<double> slip = slip_velocity(v_relative, normal);
  const double speed = norm(slip);
  if (!(speed > 0.0)) return {0.0, 0.0, 0.0};
  return (-mu * magnitude(normal_N) / speed) * slip;
}

/// Coulomb friction as an impulse, N s, limited to what stops the slip: min(mu |i|, m |slip|) e^. i is the normal
/// impulse, m the effective mass, e^ the unit vector against the slip. Inside the static cone the slip is stopped
/// completely; outside, kinetic friction acts (the paper names static friction as future work).
/// @param mass_kg  effective mass of the contact: 1 / sum_k weight_k^2 / m_k
inline V3<double> capped_friction_N_s(double mu_static, double mu_kinetic, double normal_N_s, double mass_kg,
                                      const V3<double>& v_relative, const V3<double>& normal) noexcept {
  const V3<double> slip = slip_velocity(v_relative, normal);
  const double stopping = mass_kg * norm(slip);
  if (!(stopping > 0.0)) return {0.0, 0.0, 0.0};
  const double room = magnitude(normal_N_s);
  const double size = stopping <= mu_static * room ? stopping : smaller(mu_kinetic * room, stopping);
  return (-size * mass_kg / stopping) * slip;
}

}  // namespace ligature::physics
