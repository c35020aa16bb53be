#pragma once
// Plans a pull (node and direction) that opens the knot. The paper does not describe such planning.

#include <optional>

#include "host/lab/unknotting/pull.hpp"

namespace ligature::lab {

struct Plan {
  Pull pull;
  int tried = 0;  ///< pulls simulated before this one was found
};

/// Plans from the shape alone. The tail is the thread after the knot's core. A knot opens when the tail is pulled back
/// through its last loop. So pulls at nodes near the core's end, three nodes before the tail, and against the tail's
/// direction are tried first: in the order of |nodes from there| + 2 (1 + cos of the angle to the tail). Each pull is
/// simulated on a separate thread that starts at rest from this shape. The first that ends with an unknot is the plan.
/// @param shape_W node positions (no velocities);  @param scene the thread's properties assumed by the planner.
/// @return nothing when no pull that was tried opens the knot.
[[nodiscard]] std::optional<Plan> plan_pull(std::span<const physics::Vec3> shape_W, const scene::Scene& scene);

}  // namespace ligature::lab
