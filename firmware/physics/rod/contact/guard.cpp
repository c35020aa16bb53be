// The guard: shortens a substep so that no two segments move, relative to each other, by more than 0.9 of their
// distance. Exception: pairs that a plane separates during the whole motion.

#include <algorithm>

#include "firmware/physics/closest.hpp"
#include "firmware/physics/rod/contact/contact_set.hpp"

namespace ligature::physics::rod {
namespace {

/// Distance that always remains, m. Coordinates are rounded to 6e-17 m. Without it, strands that press on each other
/// while no contact is solved come ten times nearer in each substep, until rounding lets them cross.
constexpr double kRounding_m = 1e-12;

/// Finds `least`, the largest share of a substep's motion that all tested pairs allow.
struct Share {
  const Vec *x, *v;
  double dt_s;
  double least = 1.0;

  void motion(Vec u, double distance) noexcept { faster(dot(u, u), distance); }
  void faster(double speed2, double distance) noexcept {
    const double room = 0.9 * distance, motion2 = speed2 * dt_s * dt_s;
    if (motion2 > room * room) least = std::min(least, room / std::sqrt(motion2));
  }
  void fall(double speed, double distance) noexcept {
    const double room = 0.9 * distance, way = speed * dt_s;
    if (distance > 0.0 && way > room) least = std::min(least, room / way);
  }
  void pair(std::int32_t a, std::int32_t b, double distance, const Motion& m) noexcept {
    distance = std::max(0.0, distance - kRounding_m);
    if (m.rate(a, b) * dt_s <= 0.9 * distance) return;
    // The largest relative velocity is that of two ends: those of inner points are convex combinations of these
    const Lanes ends2 = squares(v[b] - v[a], v[b + 1] - v[a], v[b] - v[a + 1], v[b + 1] - v[a + 1]);
    const double most2 = std::max(std::max(ends2[0], ends2[1]), std::max(ends2[2], ends2[3]));
    if (most2 * dt_s * dt_s <= 0.81 * distance * distance || passes_by(a, b)) return;
    faster(most2, distance);
  }
  /// Does a plane separate the pair during the whole step? Nodes move on straight lines, so it is enough that the plane
  /// separates the segments before and after the step. Its normal is the shortest connection of the segments. A tenth
  /// of their distance must remain, as in the test by speed.
  [[nodiscard]] bool passes_by(std::int32_t a, std::int32_t b) const noexcept {
    const auto c = closest(x[a], x[a + 1], x[b], x[b + 1]);
    const auto along = [&](Vec q) { return dot(c.between, q); };
    const double a1 = along(x[a + 1] - x[a]), b0 = along(x[b] - x[a]), b1 = along(x[b + 1] - x[a]);
    const double before = std::min(b0, b1) - std::max(0.0, a1);
    const double after = std::min(b0 + dt_s * along(v[b]), b1 + dt_s * along(v[b + 1])) -
                         std::max(dt_s * along(v[a]), a1 + dt_s * along(v[a + 1]));
    return std::min(before, after) > 0.1 * c.distance2;
  }
};

}  // namespace

double ContactSet::safe_fraction(const Motion& motion, const State& state, double dt_s) const noexcept {
  if (overflow_) return 0.0;
  const Vec* const v = state.v.data();
  Share share{state.x.data(), v, dt_s};
  for (const auto& c : contacts_) {
    const double distance = c.is_pair() ? c.distance_m : c.gap_m + c.reach_m;
    if (c.is_pair()) {
      share.pair(c.node[0], c.node[2], distance, motion);
    } else if (c.count == 1) {  // floor: limits the downward motion of a node that is above it
      share.fall(-dot(v[c.node[0]] - c.surface, c.n), distance);
    } else {
      for (int i = 0; i < c.count; ++i) share.motion(v[c.node[i]] - c.surface, distance);
    }
  }
  for (const auto& w : watched_) share.pair(w.a, w.b, w.distance_m, motion);
  return share.least;
}

double ContactSet::safe_fraction_of_pairs(const Motion& motion, const State& state, double dt_s) const noexcept {
  Share share{state.x.data(), state.v.data(), dt_s};
  for (const auto& pair : pairs) {
    share.pair(pair.a, pair.b, std::max(0.0, pair.due - motion.gone(pair.a, pair.b) + pair.reach_m), motion);
  }
  return share.least;
}

}  // namespace ligature::physics::rod
