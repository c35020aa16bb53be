#pragma once

#include "firmware/physics/members.hpp"
#include "firmware/physics/v3.hpp"

namespace ligature::physics {

/// Constants of the paper's contact; Table I.
struct Repulsion {
  double N_per_m = 100.0;  ///< k_rs, stiffness
  double N_s_per_m = 5.0;  ///< k_rd, damping
  LIGATURE_MEMBERS(Repulsion, stiffness, damping)
};

/// Repulsive force between two points C and E of the thread at the distance d, the paper's equation (2):
///   n = (k_rs (2 r - d) - k_rd v_r . n^) n^
/// k_rs, k_rd: spring and damper, r: radius, n^: unit vector from E to C, v_r: velocity of C relative to E. As printed
/// it attracts (n < 0) while the points separate; `clamped` (the default) limits it to n >= 0. The force still jumps
/// when approaching points touch (d = 2 r). It does not depend on mass or time step, so it is not unconditionally
/// stable.
/// @return component of n along n^, N
inline double repulsion_N(const Repulsion& k, double radius_m, double distance_m, double normal_rate_m_per_s,
                          bool clamped = true) noexcept {
  const double n = k.N_per_m * (2.0 * radius_m - distance_m) - k.N_s_per_m * normal_rate_m_per_s;
  return clamped ? larger(n, 0.0) : n;
}

}  // namespace ligature::physics
