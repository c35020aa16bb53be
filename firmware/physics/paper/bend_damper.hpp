#pragma once

#include "firmware/physics/paper/bend_geometry.hpp"

namespace ligature::physics {

/// Rate of the bend angle alpha, rad/s; grad_j is the gradient of alpha by the position of node j. Up to the sign, this
/// is the bracket in the paper's equations (10) and (11):
///   alpha' = grad_{i-1} . (v_{i-1} - v_i) + grad_{i+1} . (v_{i+1} - v_i)
template <class S>
S bend_rate(const V3<S>& grad_left, const V3<S>& grad_right, const V3<S>& v_left, const V3<S>& v_middle,
            const V3<S>& v_right) noexcept {
  return dot(grad_left, v_left - v_middle) + dot(grad_right, v_right - v_middle);
}

/// Torsional damper, the paper's equations (10)-(12). Its moment M = -k_td alpha', N m, acts on the bend angle alpha,
/// so that
///   f_{i-1} = M grad_{i-1},   f_{i+1} = M grad_{i+1},   f_i = -(f_{i-1} + f_{i+1})
/// With this sign it dissipates energy; the paper's sign adds energy (positive power in all random states tested). In
/// rigid motion the damper has no effect.
template <class S>
S bend_damper_moment_N_m(S rate, double k_N_m_s) noexcept {
  return -k_N_m_s * rate;
}

}  // namespace ligature::physics
