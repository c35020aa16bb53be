#pragma once

#include "firmware/physics/members.hpp"
#include "firmware/physics/v3.hpp"

namespace ligature::physics {

inline Pack to_pack(const V3<double>& a) noexcept { return Pack{a.x, a.y, a.z, 0.0}; }

/// Velocity of one node in one register: x, y, z, 0, in m/s.
struct NodeVelocity {
  Pack v{};
  LIGATURE_MEMBERS(NodeVelocity, pack)
};

inline double dot3(Pack a, Pack b) noexcept {
  const Pack p = a * b;
  return p[0] + p[1] + p[2];
}

/// One contact between two points of the thread, or between the thread and the desk or an obstacle. The velocity of the
/// first point relative to the second is
///   u = sum_k weight_k v_k - v_outside
/// v_k: velocities of the row's nodes, v_outside: velocity of the desk or obstacle. Members have no initial values,
/// because try_row() sets all of them.
struct ContactRow {
  Pack normal;            ///< unit, from the second body to the first
  Pack impulse;           ///< N s, on the first body
  Pack v_outside;         ///< m/s, of a moving obstacle; zero between segments
  int node[4];            ///< two of the first body, two of the second (desk, obstacle: an immobile node)
  double weight[4];       ///< barycentric, negative for the second body
  double push[4];         ///< weight_k / m_k, 1/kg
  double mass_kg;         ///< 1 / sum_k weight_k^2 / m_k
  double target_m_per_s;  ///< smallest admissible normal velocity: -gap/dt while apart; > 0 to recover from an overlap
  double stick, slip;     ///< static and kinetic friction coefficients
  int candidate;          ///< index of the candidate that stores the impulse
  LIGATURE_MEMBERS(ContactRow, normal, impulse, v_outside, node, weight, push, mass_kg, target_m_per_s, stick, slip,
                   candidate)
};

/// Projects an impulse onto the Coulomb cone about its normal: the paper's equations (1) and (3), extended by static
/// friction. Inside the static cone the contact sticks and the impulse is unchanged. Outside, friction is the kinetic
/// coefficient times the normal impulse. There is no 0/0 at zero slip, and friction never exceeds what stops the slip.
inline Pack project_on_cone(Pack impulse, Pack normal, double stick, double slip) noexcept {
  const double along = dot3(impulse, normal);
  if (along <= 0.0) return Pack{};
  const Pack across = impulse - along * normal;
  const double size2 = dot3(across, across), room = stick * along;
  if (size2 <= room * room) return impulse;
  return along * normal + (slip * along / std::sqrt(size2)) * across;
}

/// One projected Gauss-Seidel step of a contact. Computes the impulse that gives the target normal velocity and zero
/// slip, projects it onto the friction cone, and applies it to the velocities at once.
/// @return squared change of the relative velocity, (m/s)^2
inline double relax(ContactRow& r, NodeVelocity* v) noexcept {
  Pack u = r.weight[0] * v[r.node[0]].v + r.weight[1] * v[r.node[1]].v;
  u += r.weight[2] * v[r.node[2]].v + r.weight[3] * v[r.node[3]].v - r.v_outside;
  const Pack wanted = r.impulse - r.mass_kg * (u - r.target_m_per_s * r.normal);
  const Pack impulse = project_on_cone(wanted, r.normal, r.stick, r.slip);
  const Pack change = impulse - r.impulse;
  r.impulse = impulse;
  for (int k = 0; k < 4; ++k) v[r.node[k]].v += r.push[k] * change;
  return dot3(change, change) / (r.mass_kg * r.mass_kg);
}

}  // namespace ligature::physics
