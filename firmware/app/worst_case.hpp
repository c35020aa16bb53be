#pragma once
// Start shapes that make the physics as expensive as possible, for admission.

#include <vector>

#include "firmware/physics/types.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::app {

/// Nodes of a thread that lies back and forth on a square lattice, so that each row touches four others.
/// @param spacing_m distance between rows: at the thread's diameter they just touch, at less they overlap
/// @param l_rest_m distance of nodes along the thread
/// @return positions of the nodes, m, in world W; `centre_W_m` is the corner where the path begins
[[nodiscard]] std::vector<physics::Vec3> wound_up(int nodes, double l_rest_m, double spacing_m,
                                                  const physics::Vec3& centre_W_m);

/// Nodes of a ball of thread: a random walk with a pull towards its centre, so that every part is near others.
/// @param ball_m approximate radius. @return positions, m, in world W; neighbours are `l_rest_m` apart.
[[nodiscard]] std::vector<physics::Vec3> crumpled(int nodes, double l_rest_m, double ball_m,
                                                  const physics::Vec3& centre_W_m, unsigned seed);

/// State from which a tick is measured.
struct Shape {
  std::vector<physics::Vec3> p_W;  ///< empty: the scene's start shape
  std::vector<physics::Vec3> v_W;  ///< empty: at rest
};

/// All shapes to measure for a scene: wound with rows that barely touch up to heavily overlapping ones, and balls of
/// thread at rest and flying apart.
[[nodiscard]] std::vector<Shape> worst_shapes(const scene::Scene& scene);

}  // namespace ligature::app
