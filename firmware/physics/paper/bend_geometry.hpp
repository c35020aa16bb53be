#pragma once

#include "firmware/physics/paper/angle.hpp"

namespace ligature::physics {

/// The bend between two adjacent segments: its angle, its axis, and the gradients of the angle by the positions of its
/// three nodes.
template <class S>
struct Bend {
  V3<S> axis;        ///< unit binormal u1 x u2 / |u1 x u2|; zero when exactly straight
  S sine, cosine;    ///< of the angle
  S angle;           ///< alpha, rad, 0 straight, pi folded back
  V3<S> grad_left;   ///< d alpha / d P_{i-1} = -t_{i-1} / l_{i-1}, 1/m; t as in the paper, of unit length
  V3<S> grad_right;  ///< d alpha / d P_{i+1} = -t_{i+1} / l_i, 1/m;   d alpha / d P_i is minus their sum
};

/// A unit vector perpendicular to u. It serves as the axis of an exact fold (a bend by 180 degrees), where any axis
/// would do.
inline V3<double> across(const V3<double>& u) noexcept {
  const V3<double> helper = magnitude(u.x) < 0.6 ? V3<double>{1.0, 0.0, 0.0} : V3<double>{0.0, 1.0, 0.0};
  const V3<double> a = cross(u, helper);
  return (1.0 / norm(a)) * a;
}
[[gnu::noinline]] inline V3<Pack> across(const V3<Pack>& u) noexcept {
  V3<Pack> axis;
  for (int k = 0; k < kLanes; ++k) {
    const V3<double> a = across(V3<double>{u.x[k], u.y[k], u.z[k]});
    axis.x[k] = a.x, axis.y[k] = a.y, axis.z[k] = a.z;
  }
  return axis;
}

/// Computes the bend between two segments: the geometry behind the paper's equations (7)-(15). u1, u2: directions of
/// the two segments, s: axis, t_{i-1}, t_{i+1}: directions of the gradients, alpha: angle.
///   s = u1 x u2 / |u1 x u2|,  t_{i-1} = u1 x s,  t_{i+1} = u2 x s,  alpha = atan2(|u1 x u2|, u1 . u2)
/// The paper calls t a unit vector, but its formula for t has the length sin alpha. Here t has length 1, so that
/// (7)-(9) are the gradient of an energy. Near a straight bend or a fold the cross product loses digits. So s is made
/// orthogonal to both segments once more, and torques cancel to rounding error at every angle. For an exact fold the
/// axis is across(u1).
/// @param u1, u2         unit segment directions, or zero where there is no segment (all results are then finite)
/// @param inv_l1, inv_l2 inverse segment lengths, 1/m
/// Cost: about 110 operations, one root, two divisions.
template <class S>
[[gnu::always_inline]] inline Bend<S> bend_of(const V3<S>& u1, const V3<S>& u2, S inv_l1, S inv_l2) noexcept {
  constexpr double kNothing = 1e-30, kUnsure = 1e-12;
  Bend<S> b;
  b.cosine = dot(u1, u2);
  const V3<S> n = cross(u1, u2);
  b.sine = norm(n);
  b.angle = bend_angle(b.sine, b.cosine);
  const S floor = b.sine - b.sine + kNothing;
  b.axis = (1.0 / larger(b.sine, floor)) * n;
  const auto folded = (b.cosine < -0.5) & (b.sine < kUnsure);
  if (any(folded)) [[unlikely]] {
    const V3<S> a = across(u1);
    b.axis = {folded ? a.x : b.axis.x, folded ? a.y : b.axis.y, folded ? a.z : b.axis.z};
  }
  const S one = floor - floor + 1.0;
  const S side = b.cosine < 0.0 ? -one : one;
  const V3<S> q = u1 + side * u2;  // sum or, for angles above pi / 2, difference of u1 and u2: never near zero
  b.axis = b.axis - (0.5 * dot(q, b.axis) / (1.0 + magnitude(b.cosine))) * q;
  b.grad_left = (-inv_l1) * cross(u1, b.axis);
  b.grad_right = (-inv_l2) * cross(u2, b.axis);
  return b;
}

}  // namespace ligature::physics
