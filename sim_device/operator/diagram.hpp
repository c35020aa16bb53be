#pragma once
// What the eye makes of a tangle: over and under, and whether it would hold.

#include <span>

#include "sim_device/operator/sight.hpp"

namespace ligature::sim {

/// Determinant of the knot in a thread looked at along -`towards` (towards the looker), both of whose ends are led
/// straight to the looker and joined there: |det| of the colouring matrix (2 over - in - out = 0 at each crossing, one
/// row and one column left out). 1: comes undone; overhand 3, figure-eight 5, square and granny 9.
/// O(n^2 + m^3), n points, m crossings.
[[nodiscard]] int seen_determinant(std::span<const Vec3> thread_W, const Vec3& towards);

}  // namespace ligature::sim
