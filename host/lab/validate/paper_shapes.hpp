#pragma once

#include "protocol/scene/scene.hpp"

namespace ligature::validate {

/// scenes/paper.toml with the model given. A rod gets Table I per length: density N m / L, EA = k_l, EI = k_ts l / pi,
/// the dampers' times, no twist.
[[nodiscard]] scene::Scene paper_scene(scene::Model model);

}  // namespace ligature::validate
