#pragma once
// Velocities for a motion through keys without stops and without overshoot: the piecewise cubic of Fritsch and Butland
// (SIAM J. Sci. Stat. Comput. 5, 1984), called PCHIP in SciPy.

#include <span>

#include "protocol/scene/gripper_script.hpp"

namespace ligature::scene {

/// Sets the velocity at each key. For each coordinate, with the mean velocities d0 and d1 of the intervals of duration
/// h0 and h1 before and after the key: zero if d0 and d1 differ in sign or one is zero; else their weighted harmonic
/// mean (w0 + w1) / (w0 / d0 + w1 / d1), w0 = h0 + 2 h1, w1 = 2 h0 + h1. So each coordinate stays between the values of
/// the two keys. The first and last key are at rest (SciPy estimates velocities there), since the hand does not move
/// before the first key and after the last one.
/// @pre times strictly increase
void pass_through(std::span<GripKey> keys) noexcept;

}  // namespace ligature::scene
