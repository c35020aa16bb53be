#pragma once
// A thread that slips slowly round a peg.

#include "host/lab/validate/cases.hpp"

namespace ligature::validate {

/// Tension ratio T1 / T2 with `wrapped` segments on an arc of `angle_rad`: a load of T2 = 1 N hangs at one end, and T1
/// is the pull at the other end. T1 is averaged over the motion by one segment's length, because corners of the polygon
/// move on and off the peg.
/// @param drum_m_per_s  0: the thread is drawn round a peg. Else the thread is held, and the surface turns at this
/// speed, towards the load (positive) or away from it.
[[nodiscard]] double tension_ratio(const Subject& subject, double mu, double angle_rad, int wrapped,
                                   double drum_m_per_s = 0.0);

}  // namespace ligature::validate
