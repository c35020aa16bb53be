#pragma once
// Draws a loose knot of throws by two ends and tells whether it locks, by how far it slips.

#include "host/lab/published/case.hpp"
#include "host/lab/published/throws.hpp"

namespace ligature::published {

/// How a knot is drawn.
struct Drawing {
  Throws throws;
  double friction = 0.3;
  double speed_m_per_s = 0.05;  ///< of each hand, once the loose thread has been taken up
  double to_N = 5.0;            ///< the hands stop at this tension
};

struct Lock {
  bool reached = false;    ///< the tension was reached before half of the slack loop had been drawn through the knot
  bool same_knot = false;  ///< the recogniser gives the name of the loose knot
  double slip_d = 0.0;     ///< thread drawn out of the knot in the 0.5 s after the hands stopped, in diameters
  double left_N = 0.0;     ///< tension then
  bool locked = false;     ///< reached, the same knot, slip below 5 d, and more than 90 % of the tension left
};

[[nodiscard]] Lock draw_to_lock(const Subject& subject, const Drawing& drawing);

/// The friction coefficient at which the knot of `drawing` begins to lock: first a search upwards from `low` in steps
/// of a factor 1.25, then bisection until the bounds differ by the factor `apart`. Infinite when the knot does not lock
/// up to `high`.
[[nodiscard]] double locking_friction(const Subject& subject, Drawing drawing, double low, double high, double apart);

}  // namespace ligature::published
