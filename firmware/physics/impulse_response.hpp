#pragma once

#include "firmware/physics/vec.hpp"

namespace ligature::physics {

/// How an impulse at a contact is shared by the four end nodes: C a fraction a along P_a P_b, E a fraction b along P_c
/// P_d.
struct Shares {
  double a, b, c, d;  ///< positive on the first segment, negative on the second
};
inline Shares shares(double a, double b) noexcept { return {1.0 - a, a, -(1.0 - b), -b}; }

/// Size of the impulse that (19)-(22) apply, equation (18): i' = 2 |i| / (a^2 + b^2 + (1-a)^2 + (1-b)^2), i = n dt, N
/// s.
///   The reference for i is misprinted: (2), not (3). The factor 2 over the sum is Bridson's, whose i is half the
///   relative impulse; here the contact gets 1.00 to 2.00 times n dt. |i| would turn an attraction into a repulsion, so
///   i >= 0.
inline double bridson_impulse_N_s(double i_N_s, double a, double b) noexcept {
  return 2.0 * i_N_s / (a * a + b * b + (1.0 - a) * (1.0 - a) + (1.0 - b) * (1.0 - b));
}

/// New velocity of one end node, equations (19)-(22): v_new = v + share i' / m n^.
///   Linear and angular momentum are conserved: the shares sum to zero and place the impulse at C and at E.
inline V3<double> velocity_after(const V3<double>& v, double share, double impulse_N_s, double inverse_mass_per_kg,
                                 const V3<double>& direction) noexcept {
  return v + (share * impulse_N_s * inverse_mass_per_kg) * direction;
}

}  // namespace ligature::physics
