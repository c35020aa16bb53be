#pragma once
// Start shapes that make the physics as expensive as possible, for admission.

#include <vector>

#include "firmware/physics/types.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::app {

/// The thread laid back and forth on a square lattice, as dense as possible: each row touches four others.
/// @param spacing_m distance of rows; 2 r just touches, less presses rows into each other until the contact lists are
/// full
/// @param l_rest_m distance of nodes along the thread
/// @return n positions, m, in world W around `centre_W_m`
[[nodiscard]] std::vector<physics::Vec3> wound_up(int nodes, double l_rest_m, double spacing_m,
                                                  const physics::Vec3& centre_W_m);

/// A ball of thread: a random walk with a pull towards its centre, so that every part is near others.
/// @param ball_m approximate radius. @return n positions, neighbours at distance `l_rest_m`.
[[nodiscard]] std::vector<physics::Vec3> crumpled(int nodes, double l_rest_m, double ball_m,
                                                  const physics::Vec3& centre_W_m, unsigned seed);

/// State from which a tick is measured.
struct Shape {
  std::vector<physics::Vec3> p_W;  ///< empty: the scene's start shape
  std::vector<physics::Vec3> v_W;  ///< empty: at rest
};

/// All shapes to measure for a scene: wound from barely touching to heavily overlapping, crumpled at rest and flying
/// apart.
[[nodiscard]] std::vector<Shape> worst_shapes(const scene::Scene& scene);

}  // namespace ligature::app
