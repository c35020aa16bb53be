#pragma once
// Closest points of two line segments.

#include "firmware/physics/v3.hpp"

namespace ligature::physics {

/// Closest points a0 + s (a1 - a0) and b0 + t (b1 - b0) of two segments; `between` is the vector from the first point
/// to the second. Vector is V3<double> or rod::Vec for one pair, V3<Pack> for four pairs at once.
template <class Vector>
struct Closest {
  using Number = decltype(dot(Vector{}, Vector{}));
  Number s{}, t{}, distance2{};
  Vector between{};
};

/// Closest points of the segments a0 + s da and a0 + r + t db, 0 <= s, t <= 1. Minimises |r + t db - s da|^2: first s
/// without bounds from the 2 x 2 system (one half if parallel), clamped; then the best t for this s, clamped; then the
/// best s for that t. Exact, also for parallel segments (if these overlap: one of the minima) and for segments of zero
/// length. About 60 operations.
template <class Vector>
[[nodiscard]] inline Closest<Vector> closest_along(const Vector& da, const Vector& db, const Vector& r) noexcept {
  using Number = typename Closest<Vector>::Number;
  const Number aa = dot(da, da), bb = dot(db, db), ab = dot(da, db), ar = dot(da, r), br = dot(db, r);
  const Number det = aa * bb - ab * ab, half = Number{} + 0.5, tiny = Number{} + 1e-300;
  Closest<Vector> c;
  c.s = det > 1e-9 * aa * bb ? clamp01((ar * bb - br * ab) / det) : half;
  c.t = clamp01((c.s * ab - br) / larger(bb, tiny));
  c.s = clamp01((c.t * ab + ar) / larger(aa, tiny));
  c.between = r + c.t * db - c.s * da;
  c.distance2 = dot(c.between, c.between);
  return c;
}

template <class Vector>
[[nodiscard]] inline Closest<Vector> closest(const Vector& a0, const Vector& a1, const Vector& b0,
                                             const Vector& b1) noexcept {
  return closest_along(a1 - a0, b1 - b0, b0 - a0);
}

}  // namespace ligature::physics
