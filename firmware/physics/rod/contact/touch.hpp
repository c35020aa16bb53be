#pragma once
// The points along the thread at which a contact's impulse acts.

#include <algorithm>

#include "firmware/physics/members.hpp"
#include "firmware/physics/rod/tuning.hpp"

namespace ligature::physics::rod {

/// The points of a pair of segments at which its impulse acts: a and b, material coordinates, m. They follow the
/// closest points of the two segments, found at the start of each substep, but not all the way. Where strands are
/// almost parallel, a tiny rotation moves the closest points far, and the impulse there rotates the strands back one
/// substep later. This delayed feedback would make the points oscillate. So a and b minimise
///   d^2 / 2 + lag (x_a^2 + x_b^2) / 2,   lag = Tuning::touch_lag
/// d: distance between the two points, x_a and x_b: their motions along the thread (Tikhonov regularisation). The
/// segments are taken as straight, and the closest points as inside both. With the cosine c of the angle between the
/// segments, d^2 / 2 has the curvature h = 1 - c where both points move alike (both towards the end of the thread, or
/// both towards its beginning), and h = 1 + c where they move oppositely. So the points go the share h / (h + lag) of
/// the way.
///
/// A rotation moves the closest points in proportion to 1 / h. If a and b move by x, let the closest points move by
/// -G x / h one substep later. Then a and b come to rest at any angle if G < 2 lag; if the closest points move two
/// substeps later, if G < lag.
struct Touch {
  double a = 0.0, b = 0.0;

  /// Moves towards the closest points of segments with this cosine, -1 to 1. Neither point goes back, or beyond its
  /// closest point, so both stay inside of their segments.
  void follow(double to_a, double to_b, double cosine) noexcept {
    const double common = share(1.0 - cosine) * ((to_a - a) + (to_b - b));
    const double opposite = share(1.0 + cosine) * ((to_a - a) - (to_b - b));
    a = between(a, a + 0.5 * (common + opposite), to_a);
    b = between(b, b + 0.5 * (common - opposite), to_b);
  }
  LIGATURE_MEMBERS(Touch, a, b)

 private:
  [[nodiscard]] static double between(double from, double x, double to) noexcept {
    return std::min(std::max(x, std::min(from, to)), std::max(from, to));
  }
  [[nodiscard]] static double share(double h) noexcept { return h / (h + tuning.touch_lag); }
};

}  // namespace ligature::physics::rod
