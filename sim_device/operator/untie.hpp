#pragma once
// Unties a loose knot: the right hand draws the free end back through the knot's last loop.

#include "sim_device/operator/move.hpp"

namespace ligature::sim {

/// All moves, from empty hands to empty hands. The operator sees at which place of the thread the knot ends, on the
/// side of the free end. The right hand takes the thread one diameter inside the knot from there, and moves away from
/// the free end, in the direction from the end to the knot. So the end slips back into the knot and out of its last
/// loop. If a knot is still seen, the operator tries again 3 and then 5 diameters inside. The hand stops where it is
/// when the thread pulls with 1.3 times the force at which a knot is tight. A knot that is left at the end is reported
/// as a missed move.
[[nodiscard]] Moves untie();

}  // namespace ligature::sim
