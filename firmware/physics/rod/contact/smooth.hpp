#pragma once
// The smooth curve on which contacts are computed. On the polygon of segments, strands would catch at its corners.

#include <algorithm>
#include <cstddef>

#include "firmware/physics/closest.hpp"
#include "firmware/physics/rod/model/state.hpp"
#include "firmware/physics/rod/tuning.hpp"

namespace ligature::physics::rod {

/// Segment j of a smooth curve, the quadratic B-spline of the nodes. The curve touches every chord in its middle and
/// cuts the corners. Its point at the fraction s of the chord is
///   P(s) = x_j + s e_j + 1/8 (1 - s / h)_+^2 k_j + 1/8 (1 - (1 - s) / h')_+^2 k_{j+1}
/// x_j: nodes, e_j = x_{j+1} - x_j: chords, (a)_+ = max(0, a), h = h' = 1/2, k_i = e_i - e_{i-1}: corner vectors; an
/// end of the thread has no corner. Position and tangent are continuous from segment to segment, so the contact normal
/// turns smoothly as strands slide. On the polygon the normal, and with it the force, would jump by the angle of a
/// corner.
///
/// The corner at node i is a parabola from x_i - h' e_{i-1} to x_i + h e_i, so in general
///   k_i = 2 (h e_i - h' e_{i-1}).
/// When a segment is split into halves, the same length of it is twice as large a fraction of a half. So their h at the
/// old nodes is doubled, and the curve stays unchanged; h then fades back to 1/2 (State::cut_before, cut_after;
/// refine.hpp). P is linear in the nodes, so an impulse at P acts on each node with that
/// node's weight in P. Vector and Number are Vec and double for one segment, Vecs and Lanes for four.
template <class Vector, class Number>
struct SmoothOf {
  Vector x{}, e{}, before{}, after{};  ///< node, chord, k_j and k_{j+1}, m
  Number h_before{}, h_after{};        ///< 1 / h, 1 / h'

  [[nodiscard]] Vector at(Number s) const noexcept {
    const Number p = near_before(s), q = near_after(s);
    return x + s * e + (0.125 * p * p) * before + (0.125 * q * q) * after;
  }
  /// Derivative of the curve, dP / ds.
  [[nodiscard]] Vector along(Number s) const noexcept {
    return e - (0.25 * h_before * near_before(s)) * before + (0.25 * h_after * near_after(s)) * after;
  }
  [[nodiscard]] Number near_before(Number s) const noexcept { return larger(1.0 - s * h_before, Number{}); }
  [[nodiscard]] Number near_after(Number s) const noexcept { return larger(1.0 - (1.0 - s) * h_after, Number{}); }
};

struct SmoothSegment : SmoothOf<Vec, double> {
  SmoothSegment(const State& state, std::size_t j, double diameter_m) noexcept {
    x = state.x[j], e = state.x[j + 1] - state.x[j];
    h_before = 1.0 / state.cut_before[j], h_after = 1.0 / state.cut_after[j];
    double share;
    if (j > 0) corner(state, j, diameter_m, before, share);
    if (j + 2 < state.x.size()) corner(state, j + 1, diameter_m, after, share);
  }

  /// Computes the corner vector k_i of an inner node i, m. It is scaled by `share` <= 1, so that the curve cuts the
  /// corner by at most Tuning::most_cut_d diameters.
  static void corner(const State& state, std::size_t i, double diameter_m, Vec& k_i, double& share) noexcept {
    const double most_m = 8.0 * tuning.most_cut_d * diameter_m;
    const Vec k = 2.0 * state.cut_before[i] * (state.x[i + 1] - state.x[i]) -
                  2.0 * state.cut_after[i - 1] * (state.x[i] - state.x[i - 1]);
    const double size2 = dot(k, k);
    share = size2 > most_m * most_m ? most_m / std::sqrt(size2) : 1.0;
    k_i = share * k;
  }

  /// Largest distance of the curve from its chord, m.
  [[nodiscard]] double bulge() const noexcept {
    const auto across2 = [&](Vec k) { return std::max(0.0, dot(k, k) - dot(k, e) * dot(k, e) / dot(e, e)); };
    return 0.125 * std::sqrt(std::max(across2(before), across2(after)));
  }
};

/// Closest points of two smooth segments, by two Gauss-Newton steps (curvature neglected) from the closest points `c`
/// of the chords. The error is about 0.01 diameters. One step is not enough: the normal would still jump by a third of
/// a corner's angle (tests). About 460 instructions, for one pair or for four at once.
template <class Vector, class Number>
[[nodiscard]] inline Closest<Vector> closest_on_curves(const SmoothOf<Vector, Number>& a,
                                                       const SmoothOf<Vector, Number>& b, Closest<Vector> c) noexcept {
  for (int k = 0; k < 2; ++k) {
    const Vector da = a.along(c.s), db = b.along(c.t), r = b.at(c.t) - a.at(c.s);
    const Number aa = dot(da, da), bb = dot(db, db), ab = dot(da, db), ar = dot(da, r), br = dot(db, r);
    const Number det = aa * bb - ab * ab, s = c.s;
    c.s = det > 1e-9 * aa * bb ? clamp01(s + (ar * bb - br * ab) / det) : s;
    const Number t = clamp01(c.t + ((c.s - s) * ab - br) / bb);
    c.s = clamp01(s + ((t - c.t) * ab + ar) / aa);
    c.t = t;
  }
  c.between = b.at(c.t) - a.at(c.s);
  c.distance2 = dot(c.between, c.between);
  return c;
}

}  // namespace ligature::physics::rod
