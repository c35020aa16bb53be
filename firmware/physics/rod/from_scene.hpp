#pragma once
// Builds a rod from a scene.

#include <string>
#include <variant>

#include "firmware/physics/rod/rod.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::physics::rod {

/// The time steps, tolerances and work limits for the scene's key suture.accuracy. docs/measurements/accuracy.md has
/// the cost and error of each setting.
[[nodiscard]] Numerics numerics_of(const scene::Scene& scene) noexcept;

/// The effects that the scene needs.
[[nodiscard]] Parts parts_of(const scene::Scene& scene) noexcept;

/// @return the rod in its initial shape, with the scene's supports; its list of bodies has the scene's pegs and then
/// two unused places for grippers. Or the reason why the scene is refused.
[[nodiscard]] std::variant<Rod, std::string> rod_of(const scene::Scene& scene);

}  // namespace ligature::physics::rod
