#pragma once
// Random and degenerate configurations of a few nodes for tests of force laws, and sums of forces and torques.

#include <algorithm>
#include <vector>

#include "firmware/physics/v3.hpp"
#include "tests/support/random.hpp"

namespace ligature::physics::test {

using V = V3<double>;

struct Nodes {
  std::vector<V> p, v;
};

class Random : public ligature::test::Random {
 public:
  using ligature::test::Random::Random;
  double log_in(double low, double high) { return std::pow(10.0, in(std::log10(low), std::log10(high))); }
  // Braces define the order of evaluation.
  V vector(double size = 1.0) { return {in(-size, size), in(-size, size), in(-size, size)}; }
  V unit() {
    for (;;)
      if (const V a = vector(); dot(a, a) > 0.01) return (1.0 / norm(a)) * a;
  }
  Nodes nodes(int n) {
    Nodes s;
    for (int i = 0; i < n; ++i) s.p.push_back(vector()), s.v.push_back(vector());
    return s;
  }
};

/// Straight, right-angled, folded back, coincident, nearly straight and nearly folded chains of n nodes, all moving.
inline std::vector<Nodes> degenerate_nodes(int n, unsigned seed) {
  Random random(seed);
  std::vector<Nodes> all;
  for (const double turn : {0.0, 1e-15, 1e-9, 1e-5, 1.5707963267948966, 3.141592653589793 - 1e-5,
                            3.141592653589793 - 1e-9, 3.141592653589793}) {
    for (int twist = 0; twist < 3; ++twist) {
      Nodes s;
      V p{0.0, 0.0, 0.0}, d{1.0, 0.0, 0.0}, side{0.0, twist == 1 ? 0.6 : 1.0, twist == 1 ? 0.8 : 0.0};
      for (int i = 0; i < n; ++i) {
        s.p.push_back(p), s.v.push_back(random.vector());
        p = p + 0.3 * d;
        const V turned = std::cos(turn) * d + std::sin(turn) * side;
        const V next_side = std::cos(turn) * side - std::sin(turn) * d;
        side = twist == 2 && i % 2 ? cross(d, side) : next_side;
        d = turned;
      }
      all.push_back(s);
    }
  }
  Nodes same = random.nodes(n);
  for (V& p : same.p) p = same.p[0];
  all.push_back(same);
  same = random.nodes(n);
  same.p[1] = same.p[0];
  all.push_back(same);
  return all;
}

inline V sum_of(const std::vector<V>& f) {
  V s{0, 0, 0};
  for (const V& a : f) s = s + a;
  return s;
}
inline V torque_of(const std::vector<V>& p, const std::vector<V>& f) {
  V s{0, 0, 0};
  for (std::size_t i = 0; i < f.size(); ++i) s = s + cross(p[i] - p[0], f[i]);
  return s;
}
inline double power_of(const std::vector<V>& v, const std::vector<V>& f) {
  double s = 0;
  for (std::size_t i = 0; i < f.size(); ++i) s += dot(v[i], f[i]);
  return s;
}
inline double largest_of(const std::vector<V>& f) {
  double s = 0;
  for (const V& a : f) s = std::max(s, norm(a));
  return s;
}
/// Velocities of a rigid motion of these nodes.
inline std::vector<V> rigid_velocities(const std::vector<V>& p, const V& v, const V& omega) {
  std::vector<V> all;
  for (const V& x : p) all.push_back(v + cross(omega, x));
  return all;
}

}  // namespace ligature::physics::test
