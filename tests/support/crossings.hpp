#pragma once
// Detects strands that passed through each other, without code shared with the solver: end points move on straight
// lines, and at each instant at which two segments are coplanar their distance is tested.

#include <algorithm>
#include <iterator>
#include <vector>

#include "firmware/physics/closest.hpp"
#include "firmware/physics/rod/model/state.hpp"

namespace ligature::test {

using physics::closest;
using physics::rod::State;
using physics::rod::Vec;

/// End points of two segments at one instant.
struct Instant {
  Vec a0, a1, b0, b1;
};

inline Instant between(const Instant& p, const Instant& q, double t) {
  const auto mix = [t](Vec a, Vec b) { return (1.0 - t) * a + t * b; };
  return {mix(p.a0, q.a0), mix(p.a1, q.a1), mix(p.b0, q.b0), mix(p.b1, q.b1)};
}

inline double volume(const Instant& m) { return dot(cross(m.a1 - m.a0, m.b1 - m.b0), m.b0 - m.a0); }

// Whether the segments touched between states p and q. The roots of the cubic volume(t) are found by sampling and
// bisection.
inline bool crossed(const Instant& p, const Instant& q) {
  constexpr int kSamples = 16;
  double t0 = 0.0, v0 = volume(p);
  for (int k = 1; k <= kSamples; ++k) {
    const double t1 = static_cast<double>(k) / kSamples, v1 = volume(between(p, q, t1));
    if ((v0 > 0.0) != (v1 > 0.0)) {
      double low = t0, high = t1;
      for (int i = 0; i < 50; ++i) {
        const double mid = 0.5 * (low + high);
        ((volume(between(p, q, mid)) > 0.0) == (v0 > 0.0) ? low : high) = mid;
      }
      const Instant m = between(p, q, 0.5 * (low + high));
      if (closest(m.a0, m.a1, m.b0, m.b1).distance2 < 1e-18) return true;
    }
    t0 = t1, v0 = v1;
  }
  return false;
}

// Number of crossings among all pairs of segments (not only the contact list's) when nodes move straight from `before`
// to `after`. A pair is skipped if its bounding spheres, enlarged by the motion, do not meet.
inline long crossings_of_step(const std::vector<Vec>& before, const std::vector<Vec>& after) {
  struct Ball {
    Vec middle;
    double r;
  };
  std::vector<Ball> balls;
  for (std::size_t j = 0; j + 1 < before.size(); ++j) {
    const double moved = std::max(norm(after[j] - before[j]), norm(after[j + 1] - before[j + 1]));
    balls.push_back({0.5 * (before[j] + before[j + 1]), 0.5 * norm(before[j + 1] - before[j]) + moved});
  }
  long found = 0;
  for (std::size_t a = 0; a < balls.size(); ++a) {
    for (std::size_t b = a + 2; b < balls.size(); ++b) {
      const Vec off = balls[b].middle - balls[a].middle;
      const double far = balls[a].r + balls[b].r;
      if (dot(off, off) > far * far) continue;
      found += crossed({before[a], before[a + 1], before[b], before[b + 1]},
                       {after[a], after[a + 1], after[b], after[b + 1]});
    }
  }
  return found;
}

inline Vec point_at(const std::vector<double>& s, const std::vector<Vec>& x, double at) {
  auto j = static_cast<std::size_t>(std::upper_bound(s.begin() + 1, s.end() - 1, at) - s.begin()) - 1;
  const double share = (at - s[j]) / (s[j + 1] - s[j]);
  return (1.0 - share) * x[j] + share * x[j + 1];
}

// Number of crossings when remeshing replaces the polyline x0, with nodes at s0 along the thread, by that of `state`,
// and each material point moves on a straight line.
inline long crossings_of_remesh(const std::vector<double>& s0, const std::vector<Vec>& x0, const State& state) {
  const auto& s1 = state.mesh.s;
  std::vector<double> s;
  std::set_union(s0.begin(), s0.end(), s1.begin(), s1.end(), std::back_inserter(s));
  std::vector<Vec> from, to;
  for (const double at : s) from.push_back(point_at(s0, x0, at)), to.push_back(point_at(s1, state.x, at));
  const auto went = [&](std::size_t j) { return norm(to[j] - from[j]) + norm(to[j + 1] - from[j + 1]) > 1e-12; };
  long found = 0;
  for (std::size_t a = 0; a + 1 < s.size(); ++a) {
    if (!went(a)) continue;
    for (std::size_t b = 0; b + 1 < s.size(); ++b) {
      if (b + 1 >= a && b <= a + 1) continue;
      if (b > a || !went(b))
        found += crossed({from[a], from[a + 1], from[b], from[b + 1]}, {to[a], to[a + 1], to[b], to[b + 1]});
    }
  }
  return found;
}

}  // namespace ligature::test
