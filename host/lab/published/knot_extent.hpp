#pragma once
// What the contacts of a drawn knot show: where the thread enters and leaves the knot, and how hard its strands press.

#include "firmware/physics/rod/rod_simulation.hpp"

namespace ligature::published {

/// The knotted part of a thread, for a knot of two strands with a loop below it. In each strand it lies between the
/// outermost contacts that carry at least 1 % of the largest contact force. Their places, as lengths along the thread,
/// m: tail_0 and loop_0 in the strand from the thread's start to the loop, loop_1 and tail_1 in the strand from the
/// loop to the end. All zero without a contact.
struct KnotExtent {
  double tail_0 = 0.0, loop_0 = 0.0, loop_1 = 0.0, tail_1 = 0.0;
};
[[nodiscard]] KnotExtent extent_of(const physics::rod::RodSimulation& sim);

/// Sum of the normal forces with which the thread presses on itself, N.
[[nodiscard]] double normal_force_N(const physics::rod::RodSimulation& sim);

/// Position of the node next to the place `s_m` along the thread.
[[nodiscard]] physics::Vec3 place_at(const physics::rod::RodSimulation& sim, double s_m);

}  // namespace ligature::published
