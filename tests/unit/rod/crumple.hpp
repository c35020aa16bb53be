#pragma once
// Makes a crumpled thread, for tests of contact and of the cost of contact.

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "firmware/physics/closest.hpp"
#include "tests/support/random.hpp"
#include "tests/unit/rod/rods.hpp"

namespace ligature::test {

inline Vec normal_vector(Random& random) {
  const auto [x, y, z] = random.normals();
  return make(x, y, z);
}

/// The next direction of a random walk that has come to `at` and must stay within `limit_m` of the origin.
inline Vec turned(Vec along, Vec at, double limit_m, Random& random) {
  along = along + 0.6 * normal_vector(random) - (0.6 * norm(at) / limit_m / limit_m) * at;
  return (1.0 / norm(along)) * along;
}

/// Places the nodes on a random walk inside a sphere of `radius_d` thread diameters, so that all segments are close to
/// each other, and gives every node a random velocity of up to `speed_m_per_s`. Strands overlap at the start.
inline void crumple(Rod& rod, unsigned seed, double radius_d, double speed_m_per_s) {
  Random random(seed);
  auto& state = rod.state();
  const double limit_m = radius_d * 2.0 * rod.material().radius_m;
  Vec at{}, along = make(1, 0, 0);
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    state.x[i] = at;
    state.v[i] = speed_m_per_s / std::sqrt(3.0) * normal_vector(random);
    along = turned(along, at, limit_m, random);
    if (i + 1 < state.x.size()) at = at + state.mesh.rest[i] * along;
  }
  rod.moved();
}

/// The same, with all strands at least 1.2 diameters apart: a state in which a real thread can be. A step that comes
/// nearer is drawn anew; after every hundredth draw that failed, the walk goes back by ten steps.
/// @throw std::runtime_error when the sphere is too small for the thread.
inline void crumple_apart(Rod& rod, unsigned seed, double radius_d, double speed_m_per_s) {
  constexpr int kMostTries = 1'000'000;
  Random random(seed);
  auto& x = rod.state().x;
  const double diameter_m = 2.0 * rod.material().radius_m, apart_m = 1.2 * diameter_m;
  const auto is_free = [&](std::size_t i) {  // is the segment that ends at node i apart from all but its neighbour?
    for (std::size_t j = 0; j + 2 < i; ++j) {
      if (physics::closest(x[j], x[j + 1], x[i - 1], x[i]).distance2 < apart_m * apart_m) return false;
    }
    return i < 2 || norm(x[i] - x[i - 2]) > apart_m;
  };
  x[0] = Vec{};
  std::size_t i = 1;
  for (int tries = 0; i < x.size() && tries < kMostTries; ++tries) {
    const Vec before = i > 1 ? x[i - 1] - x[i - 2] : make(1, 0, 0), at = x[i - 1];
    x[i] = at + rod.state().mesh.rest[i - 1] * turned((1.0 / norm(before)) * before, at, radius_d * diameter_m, random);
    if (is_free(i)) {
      ++i;
    } else if (tries % 100 == 99) {
      i -= std::min<std::size_t>(i - 1, 10);
    }
  }
  if (i < x.size()) throw std::runtime_error("crumple_apart: the sphere is too small for the thread");
  for (auto& v : rod.state().v) v = speed_m_per_s / std::sqrt(3.0) * normal_vector(random);
  rod.moved();
}

}  // namespace ligature::test
