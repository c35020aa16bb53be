#pragma once
// Which node to pull, and which way, so that the knot comes undone: the planning that the paper leaves out.

#include <optional>

#include "host/lab/unknotting/pull.hpp"

namespace ligature::lab {

struct Plan {
  Pull pull;
  int tried = 0;  ///< pulls rehearsed before this one was found
};

/// Plans from the shape alone. The tail is what follows the knot's core; a knot opens when the tail is drawn back
/// through its last loop, so nodes just inside the core's tail end come first, then further in, and for each node the
/// directions that lead the tail back (against its own run) before the others. Each is rehearsed on a thread of its
/// own, started at rest from this shape, and the first that ends as an unknot is the plan.
/// @param shape_W nodes as seen (no velocities);  @param scene the thread's properties as the planner believes them.
/// @return nothing when no pull that was tried opens the knot.
[[nodiscard]] std::optional<Plan> plan_pull(std::span<const physics::Vec3> shape_W, const scene::Scene& scene);

}  // namespace ligature::lab
