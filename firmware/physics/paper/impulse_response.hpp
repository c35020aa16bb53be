#pragma once

#include "firmware/physics/v3.hpp"

namespace ligature::physics {

/// Shares of the four end nodes of two segments in a contact impulse. It acts between point C at fraction a along
/// segment P_a P_b and point E at fraction b along segment P_c P_d.
struct Shares {
  double a, b, c, d;  ///< positive on the first segment, negative on the second
};
inline Shares shares(double a, double b) noexcept { return {1.0 - a, a, -(1.0 - b), -b}; }

/// Size of the impulse in the paper's equations (19)-(22), by equation (18): i' = 2 |i| / (a^2 + b^2 + (1-a)^2 +
/// (1-b)^2), with i = n dt, N s (n: repulsive force). The paper refers for i to its equation (3); it must be (2). The
/// factor 2 is Bridson's, whose i is half of the relative impulse; so here a contact gets 1 to 2 times n dt. |i| would
/// turn an attraction into a repulsion, so callers pass i >= 0.
inline double bridson_impulse_N_s(double i_N_s, double a, double b) noexcept {
  return 2.0 * i_N_s / (a * a + b * b + (1.0 - a) * (1.0 - a) + (1.0 - b) * (1.0 - b));
}

/// New velocity of one end node, the paper's equations (19)-(22): v_new = v + share i' / m n^, with the node's mass m
/// and the contact's unit normal n^. Linear and angular momentum are conserved, because the shares sum to zero and
/// place the impulse at C and at E.
inline V3<double> velocity_after(const V3<double>& v, double share, double impulse_N_s, double inverse_mass_per_kg,
                                 const V3<double>& direction) noexcept {
  return v + (share * impulse_N_s * inverse_mass_per_kg) * direction;
}

}  // namespace ligature::physics
