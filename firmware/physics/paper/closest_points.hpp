#pragma once

#include "firmware/physics/paper/v3.hpp"

namespace ligature::physics {

/// Closest points of two segments: the fraction along each segment, and the vector from the second point to the first.
struct ClosestPoints {
  double a = 0.0;      ///< fraction along P1 Q1, 0 .. 1
  double b = 0.0;      ///< fraction along P2 Q2, 0 .. 1
  V3<double> apart{};  ///< point on the first minus point on the second, m
  double distance_m = 0.0;
};

/// Closest points of two segments P1 Q1 and P2 Q2; exact also for crossing, parallel, touching and zero-length ones.
/// Minimises |P1 + a (Q1 - P1) - P2 - b (Q2 - P2)|^2 for a, b in [0, 1]: first a without these bounds from the 2 x 2
/// system (one half if parallel), then b for that a within its bounds, then a for that b within its bounds. Cost: about
/// 70 operations, three divisions, one root.
inline ClosestPoints closest_points(const V3<double>& p1, const V3<double>& q1, const V3<double>& p2,
                                    const V3<double>& q2) noexcept {
  const V3<double> d1 = q1 - p1, d2 = q2 - p2, r = p1 - p2;
  const double aa = dot(d1, d1), bb = dot(d2, d2), ab = dot(d1, d2), ar = dot(d1, r), br = dot(d2, r);
  const auto clamp01 = [](double x) { return smaller(larger(x, 0.0), 1.0); };
  const double det = aa * bb - ab * ab;
  double a = det > 1e-12 * aa * bb ? clamp01((ab * br - ar * bb) / det) : 0.5;
  const double b = bb > 0.0 ? clamp01((ab * a + br) / bb) : 0.0;
  a = aa > 0.0 ? clamp01((ab * b - ar) / aa) : 0.0;
  ClosestPoints c{a, b, r + a * d1 - b * d2, 0.0};
  c.distance_m = norm(c.apart);
  return c;
}

}  // namespace ligature::physics
