#pragma once
// A pull at one node, on the thread itself or on a copy of its shape.

#include <span>
#include <string>
#include <vector>

#include "host/lab/rehearsal.hpp"

namespace ligature::lab {

/// Grasp a node and pull it away along a straight line.
struct Pull {
  int node = 0;
  physics::Vec3 direction = physics::Vec3::UnitZ();  ///< unit vector
};

struct PullResult {
  knot::KnotResult knot;     ///< knot after the pull and one second of rest
  double peak_N = 0.0;       ///< largest hand force in the thread's world
  double knot_size_m = 0.0;  ///< length of thread in the knot afterwards; 0 without a knot
  bool finite = true;
};

inline constexpr double kPullLength_m = 1.8;
inline constexpr double kPullSpeed_m_per_s = 0.6;  ///< mean speed; the hand starts and ends at rest

/// A separate thread with this shape, at rest, for trying pulls.
[[nodiscard]] physics::Simulation thread_of_shape(std::span<const physics::Vec3> shape_W, const scene::Scene& scene);

/// Pulls with the right hand, then holds for one second, on a separate thread.
[[nodiscard]] PullResult try_pull(std::span<const physics::Vec3> shape_W, const scene::Scene& scene, const Pull& pull);

/// Pulls with the right hand, then holds still for one second. Changes `thread`.
PullResult do_pull(physics::Simulation& thread, const scene::Scene& scene, const Pull& pull);

/// Position of the knot: nodes first .. last of the shortest piece that still contains it when the thread before and
/// after is cut off. Empty (first > last) without a knot. Cost O(n) recognitions.
struct Core {
  int first = 0;
  int last = -1;
};
[[nodiscard]] Core core_of(std::span<const physics::Vec3> nodes_W);

/// +x, -x, +y, -y, +z, -z
[[nodiscard]] std::span<const physics::Vec3> six_directions();
[[nodiscard]] const char* direction_name(std::size_t k);

}  // namespace ligature::lab
