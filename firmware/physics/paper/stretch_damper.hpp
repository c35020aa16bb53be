#pragma once

#include "firmware/physics/v3.hpp"

namespace ligature::physics {

/// Rate of change of a segment's length, m/s: (v_{i+1} - v_i) . e_i (v: node velocities, e_i: the segment's direction).
/// It is the bracket in the paper's linear damper, equation (6):
///   T = k_d rate, N; +T e on P_i, -T e on P_{i+1}. Power -k_d rate^2 <= 0; zero in rigid motion.
/// The paper calls the two terms of the rate norms; they are signed projections. The damper acts only on relative
/// motion, although the paper's text describes a drag.
template <class S>
S stretch_rate(const V3<S>& u, const V3<S>& v_left, const V3<S>& v_right) noexcept {
  return dot(u, v_right - v_left);
}

}  // namespace ligature::physics
