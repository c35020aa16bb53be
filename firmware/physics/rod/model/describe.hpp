#pragma once
// Tension and twist along a rod, for displays.

#include <span>

#include "firmware/physics/rod/rod.hpp"

namespace ligature::physics::rod {

/// Computes for each node the tension of the segment after it, N, and the twist angle between node 0 and this node,
/// rad. The angle grows along a segment of length ds by M ds / GJ (M: twisting moment of the last tick, GJ: twisting
/// stiffness). O(n).
void describe(const Rod& rod, std::span<float> tension_N, std::span<float> turn_rad) noexcept;

}  // namespace ligature::physics::rod
