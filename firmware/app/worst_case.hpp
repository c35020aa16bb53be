#pragma once
// Shapes that cost the thread's physics the most, laid out on purpose.

#include <vector>

#include "firmware/physics/types.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::app {

/// The thread wound to and fro on a square lattice: each row touches four others, as dense as it can lie.
/// @param spacing_m between rows; 2 r touches, less presses rows into each other until the contact lists are full.
/// @param l_rest_m distance of nodes along the thread. @return n positions, m, in world W around `centre_W_m`.
[[nodiscard]] std::vector<physics::Vec3> wound_up(int nodes, double l_rest_m, double spacing_m,
                                                  const physics::Vec3& centre_W_m);

/// All shapes to try for a scene, from touching to crushed. An empty one means: as the scene begins.
[[nodiscard]] std::vector<std::vector<physics::Vec3>> worst_shapes(const scene::Scene& scene);

}  // namespace ligature::app
