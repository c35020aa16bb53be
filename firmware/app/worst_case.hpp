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

/// A ball of thread: a random walk that is drawn back to its middle, so that everything is near everything.
/// @param ball_m its radius, about. @return n positions at distance `l_rest_m` from one to the next.
[[nodiscard]] std::vector<physics::Vec3> crumpled(int nodes, double l_rest_m, double ball_m,
                                                  const physics::Vec3& centre_W_m, unsigned seed);

/// Where a tick may begin.
struct Shape {
  std::vector<physics::Vec3> p_W;  ///< empty: as the scene begins
  std::vector<physics::Vec3> v_W;  ///< empty: at rest
};

/// All shapes to try for a scene: wound from nearly touching to crushed, crumpled at rest and flying apart.
[[nodiscard]] std::vector<Shape> worst_shapes(const scene::Scene& scene);

}  // namespace ligature::app
