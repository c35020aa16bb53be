#pragma once
// A random thread as input for the internal-force step, and its energy and momenta.

#include "firmware/physics/paper/thread.hpp"
#include "tests/unit/physics/random_states.hpp"

namespace ligature::physics::test {

struct Thread {
  ThreadModel m;
  ThreadState s;
  InternalWorkspace w;
};

/// A random walk of n nodes, up to 0.15 m per axis and step, all moving; no stiffness and no damping.
inline Thread random_thread(int n, Random& random) {
  Thread t{.m = {}, .s = {Lane3(n), Lane3(n)}, .w = InternalWorkspace(n)};
  t.m.nodes = n, t.m.rest_m = 0.1, t.m.radius_m = 0.05, t.m.mass_kg = 0.05, t.m.step_s = 1e-3;
  t.m.inverse_mass_per_kg = t.m.free = t.m.segment = Lane(n);
  V p{0, 0, 0};
  for (int i = 0; i < n; ++i) {
    t.m.inverse_mass_per_kg[i] = 20.0, t.m.free[i] = 1.0, t.m.segment[i] = i + 1 < n;
    t.s.p.put(i, p), t.s.v.put(i, random.vector());
    p = p + random.vector(0.15);
  }
  extend_last_node(t.s.p, n);
  return t;
}

inline double kinetic_J(const Thread& t) {
  double e = 0;
  for (int i = 0; i < t.m.nodes; ++i) e += 0.5 * t.m.mass_kg * dot(t.s.v.at(i), t.s.v.at(i));
  return e;
}
inline void momenta(const Thread& t, V& linear, V& angular) {
  linear = angular = {0, 0, 0};
  for (int i = 0; i < t.m.nodes; ++i) {
    linear = linear + t.m.mass_kg * t.s.v.at(i);
    angular = angular + t.m.mass_kg * cross(t.s.p.at(i), t.s.v.at(i));
  }
}

}  // namespace ligature::physics::test
