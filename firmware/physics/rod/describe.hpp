#pragma once
// A rod for those who look at it.

#include <span>

#include "firmware/physics/rod/rod.hpp"

namespace ligature::physics::rod {

/// As Simulation::describe(). The turn grows along an edge by M ds / GJ, from the twisting moments of the last tick.
void describe(const Rod& rod, std::span<float> tension_N, std::span<float> turn_rad) noexcept;

}  // namespace ligature::physics::rod
