#pragma once

#include "firmware/physics/v3.hpp"

namespace ligature::physics {

/// Direction u and length of a segment, the paper's equation (4):
///   u = (P_{i+1} - P_i) / |P_{i+1} - P_i|
/// A segment of zero length has no direction: u is then zero, so no force acts along it. Cost: one root, one division.
template <class S>
struct Segment {
  V3<S> u;       ///< unit vector from P_i to P_{i+1}
  S length_m;    ///< l_i
  S inv_length;  ///< 1 / l_i, 1/m; bounded by 1 / floor_m
};

/// @param floor_m  lower bound of the length in divisions; far below any real length
template <class S>
Segment<S> segment_of(const V3<S>& p_left, const V3<S>& p_right, S floor_m) noexcept {
  Segment<S> s;
  const V3<S> e = p_right - p_left;
  s.length_m = norm(e);
  s.inv_length = 1.0 / larger(s.length_m, floor_m);
  s.u = s.inv_length * e;
  return s;
}

/// Linear spring, the paper's equation (5), models 1-4: tension T = k_l (l - l_r) / l_r, N, of a segment of length l
/// and rest length l_r; positive pulls the two nodes together. Force +T e on P_i and -T e on P_{i+1}. k_l is a force
/// per unit strain, i.e. EA. Energy k_l l_r strain^2 / 2. The paper does not state the reaction force; without it the
/// net force on the thread was 3.4 times the largest spring force.
struct LinearStretch {
  template <class S>
  static S tension_N(S strain, double k_N) noexcept {
    return k_N * strain;
  }
  template <class S>
  static S energy_J(S strain, double k_N, double rest_m) noexcept {
    return (0.5 * k_N * rest_m) * strain * strain;
  }
  /// dT / dl, N/m
  template <class S>
  static S slope_N_per_m(S strain, double k_N, double rest_m) noexcept {
    return strain - strain + k_N / rest_m;
  }
};

/// Spring of model 5, quadratic in the strain: T = k_l |strain| strain. Energy k_l l_r |strain|^3 / 3. With the printed
/// k_l, model 5 stretches more than model 4, not less as the paper says, because strain^2 < strain below 100 %: the
/// hanging thread of Table I by 11.7 % instead of 1.5 %. With kStiffQuadratic, model 5 stretches less.
struct QuadraticStretchLaw {
  template <class S>
  static S tension_N(S strain, double k_N) noexcept {
    return k_N * magnitude(strain) * strain;
  }
  template <class S>
  static S energy_J(S strain, double k_N, double rest_m) noexcept {
    return (k_N * rest_m / 3.0) * magnitude(strain) * strain * strain;
  }
  template <class S>
  static S slope_N_per_m(S strain, double k_N, double rest_m) noexcept {
    return (2.0 * k_N / rest_m) * magnitude(strain);
  }
};

/// Factor on k_l in model 5, k5 = 100 k_l. Model 5 stretches less than model 4 where k5 strain^2 > k_l strain, i.e.
/// above a strain of k_l / k5 = 1 %. So the hanging thread of Table I (largest strain 3 %) stretches less, and with a
/// pull of 100 N ten times less.
inline constexpr double kStiffQuadratic = 100.0;

}  // namespace ligature::physics
