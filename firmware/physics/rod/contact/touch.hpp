#pragma once
// The points along the thread at which a contact's impulse acts.

#include "firmware/physics/members.hpp"
#include "firmware/physics/rod/tuning.hpp"

namespace ligature::physics::rod {

/// The points of a pair at which its impulse acts: a and b, material coordinates, m. They follow the closest points of
/// the two strands, found at the start of each substep, but not all the way. Where strands are almost parallel, a tiny
/// rotation moves the closest points far, and the impulse there rotates the strands back one substep later. This
/// delayed feedback would make the points oscillate. So a and b minimise
///   d(a, b)^2 / 2 + lag ((a - a_before)^2 + (b - b_before)^2) / 2,   lag = Tuning::touch_lag
/// where d is the distance of the points, and each strand is taken as straight (Tikhonov regularisation). With the
/// cosine c of the angle between the strands, d^2 has the curvature 1 - c for a common motion of both points, and 1 + c
/// for opposite motions. So the points go the share h / (h + lag) of the way, with h = 1 - c and 1 + c. A rotation
/// moves the closest points in proportion to 1 / h, so the feedback is in proportion to 1 / (h + lag): bounded at any
/// angle.
struct Touch {
  double a = 0.0, b = 0.0;

  /// Moves towards the closest points of strands with this cosine, -1 to 1.
  void follow(double to_a, double to_b, double cosine) noexcept {
    const double common = share(1.0 - cosine) * ((to_a - a) + (to_b - b));
    const double opposite = share(1.0 + cosine) * ((to_a - a) - (to_b - b));
    a += 0.5 * (common + opposite), b += 0.5 * (common - opposite);
  }
  LIGATURE_MEMBERS(Touch, a, b)

 private:
  [[nodiscard]] static double share(double h) noexcept { return h / (h + tuning.touch_lag); }
};

}  // namespace ligature::physics::rod
