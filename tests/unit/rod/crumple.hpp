#pragma once
// Makes a crumpled thread, for tests of contact and of the cost of contact.

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "firmware/physics/closest.hpp"
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

/// The same, with all strands at least 1.2 diameters apart: a state in which a real thread can be. Steps that come too
/// near are drawn anew, and a walk without a way out goes back by some steps.
/// @throw std::runtime_error when the sphere is too small for the thread.
inline void crumple_apart(Rod& rod, unsigned seed, double radius, double speed_m_per_s) {
  test::Random random(seed);
  const auto vector = [&] {
    const auto [x, y, z] = random.normals();
    return make(x, y, z);
  };
  auto& state = rod.state();
  const double diameter = 2.0 * rod.material().radius_m, limit = radius * diameter, apart = 1.2 * diameter;
  const auto is_free = [&](std::size_t i, Vec to) {
    for (std::size_t j = 0; j + 2 < i; ++j) {
      if (physics::closest(state.x[j], state.x[j + 1], state.x[i - 1], to).distance2 < apart * apart) return false;
    }
    return i < 2 || norm(to - state.x[i - 2]) > apart;
  };
  state.x[0] = Vec{};
  int tries = 0;
  for (std::size_t i = 1; i < state.x.size(); ++tries) {
    if (tries > 1'000'000) throw std::runtime_error("crumple_apart: the sphere is too small for the thread");
    const Vec at = state.x[i - 1], before = i > 1 ? state.x[i - 1] - state.x[i - 2] : make(1, 0, 0);
    Vec along = (1.0 / norm(before)) * before + 0.6 * vector() - (0.6 * norm(at) / limit / limit) * at;
    along = (state.mesh.rest[i - 1] / norm(along)) * along;
    if (is_free(i, at + along)) {
      state.x[i] = at + along;
      ++i;
    } else if (tries % 100 == 99) {
      i = std::max<std::size_t>(1, i - std::min<std::size_t>(i - 1, 10));
    }
  }
  for (auto& v : state.v) v = speed_m_per_s / std::sqrt(3.0) * vector();
  rod.moved();
}

}  // namespace ligature::test
