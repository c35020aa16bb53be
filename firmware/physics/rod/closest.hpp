#pragma once
// Closest points of two line segments.

#include <algorithm>

#include "firmware/physics/rod/vec.hpp"

namespace ligature::physics::rod {

/// Points a0 + s (a1 - a0) and b0 + t (b1 - b0) at the smallest distance; between = second - first.
struct Closest {
  double s = 0.0, t = 0.0, distance2 = 0.0;
  Vec between{};
};

/// Exact for every case, parallel and degenerate included (in parallel overlap one of the minima). About 60 operations.
[[nodiscard]] inline Closest closest(Vec a0, Vec a1, Vec b0, Vec b1) noexcept {
  const Vec da = a1 - a0, db = b1 - b0, r = b0 - a0;
  const double aa = dot(da, da), bb = dot(db, db), ab = dot(da, db), ar = dot(da, r), br = dot(db, r);
  const double det = aa * bb - ab * ab;
  const auto clamp01 = [](double q) { return std::clamp(q, 0.0, 1.0); };
  // Unconstrained minimum in s, clamped; then the best t for it, clamped; then the best s for that t.
  double s = det > 1e-9 * aa * bb ? clamp01((ar * bb - br * ab) / det) : 0.5;
  const double t = clamp01((s * ab - br) / std::max(bb, 1e-300));
  s = clamp01((t * ab + ar) / std::max(aa, 1e-300));
  Closest c;
  c.s = s;
  c.t = t;
  c.between = r + t * db - s * da;
  c.distance2 = dot(c.between, c.between);
  return c;
}

}  // namespace ligature::physics::rod
