#pragma once
// Tension and twist along a rod, for displays.

#include <span>

#include "firmware/physics/rod/rod.hpp"

namespace ligature::physics::rod {

/// Fills in the tension of the segment after each node, N, and the twist angle from node 0 to each node, rad. The angle
/// grows along a segment by M ds / GJ, with the twisting moment M of the last tick. O(n).
void describe(const Rod& rod, std::span<float> tension_N, std::span<float> turn_rad) noexcept;

}  // namespace ligature::physics::rod
