#pragma once

#include "protocol/scene/scene.hpp"

namespace ligature::validate {

/// scenes/paper.toml with the given model. For a rod, the values of the paper's Table I (N nodes of mass m, segment
/// length l, stretch and bending constants k_l and k_ts) are converted: density N m / L (L length), EA = k_l, EI = k_ts
/// l / pi, damping constants to times, no twist.
[[nodiscard]] scene::Scene paper_scene(scene::Model model);

}  // namespace ligature::validate
