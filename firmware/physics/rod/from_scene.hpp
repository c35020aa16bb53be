#pragma once
// From a scene's numbers to a rod ready to tick.

#include <string>
#include <variant>

#include "firmware/physics/rod/rod.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::physics::rod {

/// Settings behind `accuracy` (docs/accuracy.md states what each costs and errs).
[[nodiscard]] Numerics numerics_of(const scene::Scene& scene) noexcept;

/// Parts that the scene asks for and no others.
[[nodiscard]] Parts parts_of(const scene::Scene& scene) noexcept;

/// @return the rod in its initial shape, held by the scene's supports, with room for two gripper capsules after the
/// pegs; or why not.
[[nodiscard]] std::variant<Rod, std::string> rod_of(const scene::Scene& scene);

}  // namespace ligature::physics::rod
