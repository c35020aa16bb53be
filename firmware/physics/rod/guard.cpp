// The guard: no pair of segments may move, relative to each other, by more than its distance.

#include <algorithm>

#include "firmware/physics/rod/contact.hpp"

namespace ligature::physics::rod {
namespace {

/// Smallest share of a substep's motion that anything seen so far may make.
struct Share {
  const Vec* v;
  double dt_s;
  double least = 1.0;

  void motion(Vec u, double distance) noexcept {
    const double room = 0.9 * distance, motion2 = dot(u, u) * dt_s * dt_s;
    if (motion2 > room * room) least = std::min(least, room / std::sqrt(motion2));
  }
  void fall(double speed, double distance) noexcept {
    const double room = 0.9 * distance, way = speed * dt_s;
    if (distance > 0.0 && way > room) least = std::min(least, room / way);
  }
  void pair(std::int32_t a, std::int32_t b, double distance, const Motion& m) noexcept {
    const auto p = static_cast<std::size_t>(a), q = static_cast<std::size_t>(b);
    if (m.rate(p, q) * dt_s <= 0.9 * distance) return;
    motion(v[b] - v[a], distance);  // points in between move no more than the ends
    motion(v[b + 1] - v[a], distance);
    motion(v[b] - v[a + 1], distance);
    motion(v[b + 1] - v[a + 1], distance);
  }
};

}  // namespace

double ContactSet::safe_fraction(const Motion& motion, const Vec* v, double dt_s) const noexcept {
  if (overflow_) return 0.0;
  Share share{v, dt_s};
  for (const auto& c : contacts_) {
    const double distance = c.count == 4 ? c.distance_m : c.gap_m + c.reach_m;
    if (c.count == 4) {
      share.pair(c.node[0], c.node[2], distance, motion);
    } else if (c.count == 1) {  // a plane: what is below it already may only come up
      share.fall(-dot(v[c.node[0]] - c.surface, c.n), distance);
    } else {
      for (int i = 0; i < c.count; ++i) share.motion(v[c.node[i]] - c.surface, distance);
    }
  }
  for (const auto& w : watched_) share.pair(w.a, w.b, w.distance_m, motion);
  return share.least;
}

double ContactSet::safe_fraction_of_pairs(const Motion& motion, const Vec* v, double dt_s) const noexcept {
  Share share{v, dt_s};
  for (const auto& pair : pairs) {
    const auto a = static_cast<std::size_t>(pair.a), b = static_cast<std::size_t>(pair.b);
    share.pair(pair.a, pair.b, std::max(0.0, pair.due - motion.gone(a, b) + pair.reach_m), motion);
  }
  return share.least;
}

}  // namespace ligature::physics::rod
