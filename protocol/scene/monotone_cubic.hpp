#pragma once
// A hand that goes through its keys without a stop, and never beyond them: the piecewise cubic of Fritsch and Butland
// (SIAM J. Sci. Stat. Comput. 5, 1984), which SciPy calls PCHIP.

#include <span>

#include "protocol/scene/gripper_script.hpp"

namespace ligature::scene {

/// Gives each key the velocity with which the hand passes it. For each coordinate, with the mean velocities d0 and d1
/// of the intervals h0 and h1 beside the key: zero where they differ in sign or one is zero, else their weighted
/// harmonic mean (w0 + w1) / (w0 / d0 + w1 / d1), w0 = h0 + 2 h1, w1 = 2 h0 + h1. So between two keys a coordinate
/// stays between theirs. The first and the last key are at rest (SciPy estimates them), since the hand is held before
/// and after.
/// @pre times strictly increase
void pass_through(std::span<GripKey> keys) noexcept;

}  // namespace ligature::scene
