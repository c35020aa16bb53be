#pragma once

#include "host/lab/validate/cases.hpp"

namespace ligature::validate {

/// What a twisted and shortened rod of n nodes settles into.
struct Helix {
  double angle_rad = 0.0;  ///< largest angle between tangent and axis, interpolated
  double moment_Nm = 0.0;
  double envelope_error = 0.0;  ///< largest |f - tanh^2(sigma s)|
};
/// @param substeps implicit steps per 0.1 s
/// @param adaptive nodes gather in the bulge (where there are too many for that, they stay equally spaced)
[[nodiscard]] Helix localised_helix_of(int n, int substeps, bool adaptive);

/// Angle, moment and decay rate of the infinite rod's solution.
struct HelixTruth {
  double phi0_rad, M, sigma;
};
[[nodiscard]] HelixTruth helix_truth();

}  // namespace ligature::validate
