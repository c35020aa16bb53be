#pragma once

#include <numbers>

#include "firmware/physics/paper/bend_geometry.hpp"

namespace ligature::physics {

/// Torsional spring, the paper's equations (7)-(9). Its moment M acts on the bend angle alpha; P_j: position of node j.
///   M = -(k_ts / pi) alpha, N m;   f_{i-1} = M d alpha/dP_{i-1},  f_{i+1} = M d alpha/dP_{i+1},
///   f_i = -(f_{i-1} + f_{i+1})
/// This is (7)-(9) with a unit vector t, so that the force is minus the gradient of E = k_ts alpha^2 / (2 pi). With the
/// printed t, of length sin alpha, a nearly straight bend would have no linear stiffness, and a fold no force.
/// @param k_N_m  k_ts, bending stiffness
template <class S>
S bend_moment_N_m(S angle, double k_N_m) noexcept {
  return (-k_N_m / std::numbers::pi) * angle;
}

template <class S>
S bend_energy_J(S angle, double k_N_m) noexcept {
  return (0.5 * k_N_m / std::numbers::pi) * angle * angle;
}

}  // namespace ligature::physics
