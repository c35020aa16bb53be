#pragma once
// The rod's contacts in the form of simulation.hpp.

#include <span>

#include "firmware/physics/contact_point.hpp"
#include "firmware/physics/rod/rod.hpp"

namespace ligature::physics {

/// @see Simulation::contacts
[[nodiscard]] std::size_t rod_contacts(const rod::Rod& rod, std::span<ContactPoint> out) noexcept;

}  // namespace ligature::physics
