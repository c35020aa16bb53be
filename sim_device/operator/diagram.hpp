#pragma once
// Recognises knots from the thread's projection: crossings, over and under.

#include <span>

#include "sim_device/operator/sight.hpp"

namespace ligature::sim {

/// Determinant of the knot in a thread seen from the direction `towards`, with both ends extended to the viewer and
/// joined there: |det| of the colouring matrix (2 over - in - out = 0 at each crossing; one row and one column
/// removed). 1: unknotted or not recognised as knotted; overhand 3, figure-eight 5, square and granny 9. O(n^2 + m^3)
/// for n points and m crossings.
[[nodiscard]] int seen_determinant(std::span<const Vec3> thread_W, const Vec3& towards);

}  // namespace ligature::sim
