#pragma once

#include <string>

#include "protocol/scene/scene.hpp"

namespace ligature::lab {

/// Why a run of this scene most likely diverged: the term that oversteps the largest stable step of an explicit scheme
/// the most, with its key, its limit and what would help. A guess from linear stability limits of a uniform chain:
///   stretch   dt < sqrt(m l / EA)            bend   dt < l sqrt(pi m / (4 k_ts))       coupling  dt < 2 sqrt(m / K)
///   stretch damper (explicit)  dt < m / (2 k_d)     bend damper (explicit)  dt < m l^2 / (8 k_td)
///   coupling damper  dt < 2 m / B            forward Euler  dt < k_d l / EA
[[nodiscard]] std::string likely_cause(const scene::Scene& scene);

}  // namespace ligature::lab
