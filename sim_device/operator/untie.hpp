#pragma once
// Unties a loose knot: the right hand draws the free end back through the knot's last loop.

#include "sim_device/operator/move.hpp"

namespace ligature::sim {

/// All moves from empty hands to empty hands. The operator sees where the knot ends, takes the thread just before that
/// place, and draws it back along the free end. If a knot is still seen, the operator tries again with a place further
/// inside, three times in all. A pull ends early when it reaches 1.3 times the pull at which a knot is tight. A knot
/// that is left at the end is reported as a missed move.
[[nodiscard]] Moves untie();

}  // namespace ligature::sim
