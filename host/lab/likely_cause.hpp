#pragma once

#include <string>

#include "protocol/scene/scene.hpp"

namespace ligature::lab {

/// The most likely reason why a run of this scene diverged: the term whose largest stable time step for an explicit
/// scheme is exceeded by the largest factor, with its key, the limit and a remedy. An estimate from the linear
/// stability limits of a uniform chain (m node mass, l segment length, EA stretch stiffness, k_ts and k_td bending
/// stiffness and damping, k_d stretch damping, K and B stiffness and damping of the hand's coupling):
///   stretch   dt < sqrt(m l / EA)            bend   dt < l sqrt(pi m / (4 k_ts))       coupling  dt < 2 sqrt(m / K)
///   stretch damper (explicit)  dt < m / (2 k_d)     bend damper (explicit)  dt < m l^2 / (8 k_td)
///   coupling damper  dt < 2 m / B            forward Euler  dt < k_d l / EA
[[nodiscard]] std::string likely_cause(const scene::Scene& scene);

}  // namespace ligature::lab
