#pragma once

#include "protocol/scene/scene.hpp"

namespace ligature::validate {

/// scenes/paper.toml with the given model. For a rod, Table I is converted to values per length: density N m / L, EA =
/// k_l, EI = k_ts l / pi, damping times, no twist.
[[nodiscard]] scene::Scene paper_scene(scene::Model model);

}  // namespace ligature::validate
