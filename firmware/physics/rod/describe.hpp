#pragma once
// Tension and twist along a rod, for displays.

#include <span>

#include "firmware/physics/rod/rod.hpp"

namespace ligature::physics::rod {

/// As Simulation::describe(). The angle grows along a segment by M ds / GJ, with the twisting moments of the last tick.
void describe(const Rod& rod, std::span<float> tension_N, std::span<float> turn_rad) noexcept;

}  // namespace ligature::physics::rod
