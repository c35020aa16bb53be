#pragma once

#include "firmware/physics/paper/bend_geometry.hpp"

namespace ligature::physics {

/// Swivel rates, m/s: speeds at which the two end nodes of a bend leave the bend's plane, relative to the middle node.
template <class S>
struct SwivelRates {
  S left, right;
};
template <class S>
SwivelRates<S> swivel_rates(const V3<S>& axis, const V3<S>& v_left, const V3<S>& v_middle,
                            const V3<S>& v_right) noexcept {
  return {dot(axis, v_left - v_middle), dot(axis, v_right - v_middle)};
}

/// The paper's swivel damper, equations (13)-(15), with the sign that damps:
///   f_{i-1} = -k_sw ((v_{i-1} - v_i) . s) s / l_{i-1},   f_{i+1} likewise over l_i,   f_i = -(f_{i-1} + f_{i+1})
/// s is e_{i-1} x e_i made a unit vector, as the paper's text calls it (its formula has length sin alpha); zero when
/// the bend is exactly straight. With the printed sign (plus) the damper adds energy. With either sign it is not an
/// internal force: three points have only three internal degrees of freedom (two lengths and an angle). So it leaves a
/// net torque and damps rigid rotation, like a drag.
/// @return coefficient of the unit axis per unit swivel rate, N s/m
template <class S>
S paper_swivel_N_s_per_m(S inv_length, double k_N_s) noexcept {
  return k_N_s * inv_length;
}

/// The internal swivel damper acts on the rate of the dihedral angle phi of four nodes. The weight w keeps it finite on
/// a straight thread, where phi is undefined. alpha_1, alpha_2: angles of the two bends, sin1, cos1 .. their sines and
/// cosines; l1 .. l3: lengths of the segments.
///   rate = w phi',  w = sin(alpha_1) sin(alpha_2);   force on node j: -k (w phi') (w d phi/dP_j)
/// w grad phi lies along the two axes s1 (of the bend of nodes 0, 1, 2) and s2 (of nodes 1, 2, 3):
///     node 0:  p0 s1    node 1: p1 s1 + q1 s2    node 2: p2 s1 + q2 s2    node 3: q3 s2
///     p0 = -sin2 / l1, p2 = -sin2 cos1 / l2, p1 = -(p0 + p2);   q3 = sin1 / l3, q1 = sin1 cos2 / l2, q2 = -(q1 + q3)
/// The force is internal: no net force or torque, none in rigid motion, power -k rate^2. k = k_sw l_r, N m s, so that
/// at a right angle the force on an end node equals the paper's.
template <class S>
struct Dihedral {
  S p0, p2, q1, q3;
};
template <class S>
Dihedral<S> dihedral_of(S sin1, S cos1, S sin2, S cos2, S inv_l1, S inv_l2, S inv_l3) noexcept {
  return {-sin2 * inv_l1, -sin2 * cos1 * inv_l2, sin1 * cos2 * inv_l2, sin1 * inv_l3};
}

template <class S>
S dihedral_rate(const Dihedral<S>& d, const SwivelRates<S>& first, const SwivelRates<S>& second) noexcept {
  return d.p0 * first.left + d.p2 * first.right + d.q1 * second.left + d.q3 * second.right;
}

/// Mobility of a dihedral for the implicit damper: g^T M^-1 g, with the gradient g of its angle and the masses M.
/// @param axes  s1 . s2    @param w0..w3  inverse masses of the four nodes, 1/kg
template <class S>
S dihedral_mobility(const Dihedral<S>& d, S axes, S w0, S w1, S w2, S w3) noexcept {
  const S p1 = -(d.p0 + d.p2), q2 = -(d.q1 + d.q3);
  return w0 * d.p0 * d.p0 + w1 * (p1 * p1 + d.q1 * d.q1 + 2.0 * axes * p1 * d.q1) +
         w2 * (d.p2 * d.p2 + q2 * q2 + 2.0 * axes * d.p2 * q2) + w3 * d.q3 * d.q3;
}

}  // namespace ligature::physics
