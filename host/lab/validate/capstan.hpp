#pragma once
// A thread that slips slowly round a peg.

#include "host/lab/validate/cases.hpp"

namespace ligature::validate {

/// Tension ratio T1 / T2 with `wrapped` segments on an arc of `angle_rad`: T2 = 1 N loads one end, T1 is the pull at
/// the other end. Averaged over one segment's length, because polygon corners move on and off the peg.
[[nodiscard]] double tension_ratio(const Subject& subject, double mu, double angle_rad, int wrapped);

}  // namespace ligature::validate
