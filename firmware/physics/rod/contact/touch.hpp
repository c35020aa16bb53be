#pragma once
// The points along the thread at which a contact's impulse acts.

#include <algorithm>

#include "firmware/physics/members.hpp"

namespace ligature::physics::rod {

/// The points of a pair at which its impulse acts. They follow the closest points found at the start of each substep,
/// but not at once. Where two strands are almost parallel, a tiny rotation moves the closest points far, and the
/// impulse there rotates the strands back one substep later. This delayed feedback makes the closest points oscillate
/// (by 1.5 % of a segment in a held square knot, which moved a loose neighbour at 25 mm/s). So the points move only by
/// `share` of the way to the closest points. Aitken relaxation adapts the share [Irons & Tuck 1969]; it is 1 where
/// there is no such feedback, as when strands slide.
struct Touch {
  double a = 0.0, b = 0.0;          ///< material coordinates, m
  double way_a = 0.0, way_b = 0.0;  ///< way to the closest points in the last substep, m
  double share = 1.0;               ///< share of that way by which the points moved

  /// Starts a new contact at the closest points.
  void begin(double at_a, double at_b) noexcept { *this = {at_a, at_b}; }
  /// Moves towards the new closest points.
  void follow(double to_a, double to_b) noexcept {
    const double now_a = to_a - a, now_b = to_b - b;
    const double last2 = way_a * way_a + way_b * way_b;
    if (last2 > 0.0) {
      const double rest = (now_a * way_a + now_b * way_b) / last2;  // remaining share of the last way; < 0: overshoot
      share = rest < 1.0 ? std::min(1.0, share / (1.0 - rest)) : 1.0;
    }
    way_a = now_a, way_b = now_b;
    a += share * now_a, b += share * now_b;
  }
  LIGATURE_MEMBERS(Touch, a, b, way_a, way_b, share)
};

}  // namespace ligature::physics::rod
