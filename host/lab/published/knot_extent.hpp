#pragma once
// What the contacts of a drawn knot tell: where the thread enters and leaves it, and how hard its strands press.

#include "firmware/physics/rod/rod_simulation.hpp"

namespace ligature::published {

/// A knot with a loop below it has two strands. Lengths along the thread at the outermost contacts of each that carry
/// at least 1 % of the largest contact force, m: from end to loop tail_0 .. loop_0, and from loop to end loop_1 ..
/// tail_1. All zero without a contact.
struct KnotExtent {
  double tail_0 = 0.0, loop_0 = 0.0, loop_1 = 0.0, tail_1 = 0.0;
};
[[nodiscard]] KnotExtent extent_of(const physics::rod::RodSimulation& sim);

/// Sum of the normal forces with which the thread presses on itself, N.
[[nodiscard]] double normal_force_N(const physics::rod::RodSimulation& sim);

/// Position of the node next to the place `s_m` along the thread.
[[nodiscard]] physics::Vec3 place_at(const physics::rod::RodSimulation& sim, double s_m);

}  // namespace ligature::published
