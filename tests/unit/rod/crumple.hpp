#pragma once
// Makes a crumpled thread, for tests of contact and of the cost of contact.

#include <cmath>

#include "tests/support/random.hpp"
#include "tests/unit/rod/rods.hpp"

namespace ligature::test {

/// Places the nodes on a random walk inside a sphere of `radius` thread diameters, so that all segments are close to
/// each other, and gives every node a random velocity of up to `speed_m_per_s`.
inline void crumple(Rod& rod, unsigned seed, double radius, double speed_m_per_s) {
  test::Random random(seed);
  const auto vector = [&] {
    const auto [x, y, z] = random.normals();
    return make(x, y, z);
  };
  auto& state = rod.state();
  const double limit = radius * 2.0 * rod.material().radius_m;
  Vec at{}, along = make(1, 0, 0);
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    state.x[i] = at;
    state.v[i] = speed_m_per_s / std::sqrt(3.0) * vector();
    along = along + 0.6 * vector() - (0.6 * norm(at) / limit / limit) * at;
    along = (1.0 / norm(along)) * along;
    if (i + 1 < state.x.size()) at = at + state.mesh.rest[i] * along;
  }
  rod.moved();
}

}  // namespace ligature::test
