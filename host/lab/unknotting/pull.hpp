#pragma once
// One pull at one node, on the thread itself or tried on another of the same shape.

#include <span>
#include <string>
#include <vector>

#include "host/lab/rehearsal.hpp"

namespace ligature::lab {

/// Take a node and draw it away, straight.
struct Pull {
  int node = 0;
  physics::Vec3 direction = physics::Vec3::UnitZ();  ///< unit vector
};

struct PullResult {
  knot::KnotResult knot;     ///< after the pull and a second of rest
  double peak_N = 0.0;       ///< largest hand force, world
  double knot_size_m = 0.0;  ///< length of thread in the knot afterwards; 0 when there is none
  bool finite = true;
};

inline constexpr double kPullLength_m = 1.8;
inline constexpr double kPullSpeed_m_per_s = 0.6;  ///< mean; the hand starts and ends at rest

/// A thread of its own with this shape, at rest: what a pull can be tried on.
[[nodiscard]] physics::Simulation thread_of_shape(std::span<const physics::Vec3> shape_W, const scene::Scene& scene);

/// Pulls with the right hand, then holds for a second, on a thread of its own.
[[nodiscard]] PullResult try_pull(std::span<const physics::Vec3> shape_W, const scene::Scene& scene, const Pull& pull);

/// The same pull on the thread itself.
PullResult do_pull(physics::Simulation& thread, const scene::Scene& scene, const Pull& pull);

/// Where the knot sits: the shortest stretch of nodes first .. last such that the thread before `first` and after
/// `last` can be cut off and the knot is still there. Empty (first > last) when there is no knot. Cost O(n)
/// recognitions.
struct Core {
  int first = 0;
  int last = -1;
};
[[nodiscard]] Core core_of(std::span<const physics::Vec3> nodes_W);

/// +x, -x, +y, -y, +z, -z
[[nodiscard]] std::span<const physics::Vec3> six_directions();
[[nodiscard]] const char* direction_name(std::size_t k);

}  // namespace ligature::lab
