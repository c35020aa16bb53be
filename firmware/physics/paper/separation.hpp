#pragma once

#include "firmware/physics/paper/impulse_response.hpp"

namespace ligature::physics {

/// Shift of each of two overlapping segments, m (paper, V.A): r - d/2 + eps/2, with radius r, distance d and safety
/// distance eps; 0 if the segments do not overlap.
inline double separation_m(double radius_m, double distance_m, double safety_m) noexcept {
  return distance_m < 2.0 * radius_m ? radius_m - 0.5 * distance_m + 0.5 * safety_m : 0.0;
}

/// Displacements of the four end nodes along the normal which separate the closest points C and E of two segments by
/// twice separation_m. The paper shifts all four nodes by the same amount, which adds a rigid rotation (median: 1.5
/// times the shift). Here the shifts are proportional to share_k / m_k, as for an impulse, so that the centre of mass
/// stays.
/// @param w  inverse masses, 1/kg   @return factors: node k moves by factor_k along the normal, m
inline Shares separating_shifts(double separation_each_m, const Shares& s, const Shares& w) noexcept {
  const double mobility = s.a * s.a * w.a + s.b * s.b * w.b + s.c * s.c * w.c + s.d * s.d * w.d;
  if (!(mobility > 0.0)) return {0.0, 0.0, 0.0, 0.0};
  const double size = 2.0 * separation_each_m / mobility;
  return {size * s.a * w.a, size * s.b * w.b, size * s.c * w.c, size * s.d * w.d};
}

}  // namespace ligature::physics
