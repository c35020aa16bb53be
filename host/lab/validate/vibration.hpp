#pragma once

#include "host/lab/validate/cases.hpp"

namespace ligature::validate {

/// Mode shape of a cantilever of length 1, clamped at s = 0 [Euler-Bernoulli].
[[nodiscard]] double cantilever_shape(double beta, double s);

/// Numerical damping of mode 1 .. 3 of the 0.3 m suture held at one end, as a fraction of critical damping, caused by
/// the time steps of the given accuracy. All physical damping is off.
[[nodiscard]] double numerical_damping(const Subject& subject, scene::Accuracy accuracy, int mode);

}  // namespace ligature::validate
