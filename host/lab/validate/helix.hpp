#pragma once

#include "host/lab/validate/cases.hpp"

namespace ligature::validate {

/// Equilibrium of a twisted and shortened rod of n nodes.
struct Helix {
  double angle_rad = 0.0;  ///< largest angle between tangent and axis, interpolated between segments
  double moment_Nm = 0.0;
  double envelope_error = 0.0;  ///< largest |f - tanh^2(sigma s)|; s from the bulge's centre, f in HelixTruth
};
/// @param substeps implicit steps per 0.1 s
/// @param adaptive true: nodes concentrate in the bulge (not if segments there would become too short)
[[nodiscard]] Helix localised_helix_of(int n, int substeps, bool adaptive);

/// Solution for an infinite rod: largest angle phi between tangent and axis, twisting moment M (N m), and decay rate
/// sigma (1/m) of the bulge's envelope f = (cos phi(s) - cos phi0) / (1 - cos phi0) = tanh^2(sigma s).
struct HelixTruth {
  double phi0_rad, M, sigma;
};
[[nodiscard]] HelixTruth helix_truth();

}  // namespace ligature::validate
