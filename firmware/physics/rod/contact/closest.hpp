#pragma once
// Closest points of two line segments.

#include "firmware/physics/rod/vec.hpp"

namespace ligature::physics::rod {

/// Closest points a0 + s (a1 - a0) and b0 + t (b1 - b0) of two segments; `between` is the vector from the first point
/// to the second. Vector and Number are Vec and double for one pair, Vecs and Lanes for four at once.
template <class Vector, class Number>
struct ClosestOf {
  Number s{}, t{}, distance2{};
  Vector between{};
};
using Closest = ClosestOf<Vec, double>;
using FourClosest = ClosestOf<Vecs, Lanes>;

/// Closest points of the segments a0 + s da and a0 + r + t db, 0 <= s, t <= 1. Exact, also for parallel segments (if
/// these overlap: one of the minima) and for segments of zero length. About 60 operations.
template <class Vector, class Number>
[[nodiscard]] inline ClosestOf<Vector, Number> closest_along(const Vector& da, const Vector& db,
                                                             const Vector& r) noexcept {
  const Number aa = dot(da, da), bb = dot(db, db), ab = dot(da, db), ar = dot(da, r), br = dot(db, r);
  const Number det = aa * bb - ab * ab, half = Number{} + 0.5, tiny = Number{} + 1e-300;
  // The minimum over s without bounds, clamped to 0 .. 1; then the best t for this s, clamped; then the best s for that
  // t
  ClosestOf<Vector, Number> c;
  c.s = det > 1e-9 * aa * bb ? clamp01((ar * bb - br * ab) / det) : half;
  c.t = clamp01((c.s * ab - br) / (bb > tiny ? bb : tiny));
  c.s = clamp01((c.t * ab + ar) / (aa > tiny ? aa : tiny));
  c.between = r + c.t * db - c.s * da;
  c.distance2 = dot(c.between, c.between);
  return c;
}

[[nodiscard]] inline Closest closest(Vec a0, Vec a1, Vec b0, Vec b1) noexcept {
  return closest_along<Vec, double>(a1 - a0, b1 - b0, b0 - a0);
}

}  // namespace ligature::physics::rod
