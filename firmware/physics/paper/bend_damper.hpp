#pragma once

#include "firmware/physics/paper/bend_geometry.hpp"

namespace ligature::physics {

/// Rate of the bend angle, rad/s: the bracket of the paper's equations (10) and (11) up to sign,
///   alpha' = grad_{i-1} . (v_{i-1} - v_i) + grad_{i+1} . (v_{i+1} - v_i)
template <class S>
S bend_rate(const V3<S>& grad_left, const V3<S>& grad_right, const V3<S>& v_left, const V3<S>& v_middle,
            const V3<S>& v_right) noexcept {
  return dot(grad_left, v_left - v_middle) + dot(grad_right, v_right - v_middle);
}

/// Torsional damper, equations (10)-(12), as a generalised force on the bend angle: M = -k_td alpha', N m.
///   f_{i-1} = M grad_{i-1}, f_{i+1} = M grad_{i+1}, f_i = minus their sum. The paper has the opposite sign, which adds
///   energy (power > 0 in all of the random states tested); this one dissipates energy, and is zero in rigid motion.
template <class S>
S bend_damper_moment_N_m(S rate, double k_N_m_s) noexcept {
  return -k_N_m_s * rate;
}

}  // namespace ligature::physics
