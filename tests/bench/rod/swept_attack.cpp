// Attacks the guarantee that strands never pass through each other: hairpins whose arms are thrown at each other at up
// to 50 m/s each, at random angles (parallel and grazing among them), sizes and node counts. Between any two states of
// a substep every pair of segments is checked for having crossed, by means that share nothing with the solver: the two
// segments are followed along their straight motion, and at every instant at which they are coplanar it is asked
// whether they meet.
//
// Usage: rod_swept_attack [approaches = 10000] [seed = 1]; prints crossings found; exit 1 if any.

#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <random>

#include "firmware/physics/rod/closest.hpp"
#include "firmware/physics/rod/rod.hpp"

using namespace ligature::physics::rod;

namespace {

struct Motion {
  Vec a0, a1, b0, b1;  // at an instant
};

Motion between(const Motion& p, const Motion& q, double t) {
  const auto mix = [t](Vec a, Vec b) { return (1.0 - t) * a + t * b; };
  return {mix(p.a0, q.a0), mix(p.a1, q.a1), mix(p.b0, q.b0), mix(p.b1, q.b1)};
}

double volume(const Motion& m) { return dot(cross(m.a1 - m.a0, m.b1 - m.b0), m.b0 - m.a0); }

// Did the segments meet on the way from p to q? Roots of the cubic volume(t) by sampling and bisection.
bool crossed(const Motion& p, const Motion& q) {
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
      const Motion m = between(p, q, 0.5 * (low + high));
      if (closest(m.a0, m.a1, m.b0, m.b1).distance2 < 1e-18) return true;
    }
    t0 = t1, v0 = v1;
  }
  return false;
}

// A hairpin: arm 1 along x, a half circle upwards, arm 2 back, turned about z by `angle`.
void shape(Rod& rod, double gap, double angle, double speed1, double speed2, double sideways) {
  State& state = rod.state();
  const double length = rod.material().length_m, r = 0.5 * gap, bend = std::numbers::pi * r,
               arm = 0.5 * (length - bend);
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    const double s = state.mesh.s[i];
    if (s < arm) {
      state.x[i] = make(s, 0, 0);
      state.v[i] = make(0, 0, speed1);
    } else if (s < arm + bend) {
      const double a = (s - arm) / r;
      state.x[i] = make(arm + r * std::sin(a), 0, r * (1.0 - std::cos(a)));
    } else {
      const double back = s - arm - bend;
      state.x[i] = make(arm - back * std::cos(angle), back * std::sin(angle), gap);
      state.v[i] = make(sideways, sideways, -speed2);
    }
  }
  rod.moved();
}

}  // namespace

int main(int argc, char** argv) {
  const long approaches = argc > 1 ? std::atol(argv[1]) : 10000;
  std::mt19937_64 random(argc > 2 ? static_cast<unsigned>(std::atoi(argv[2])) : 1U);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  long found = 0, guarded = 0, substeps = 0;
  for (long k = 0; k < approaches; ++k) {
    static constexpr int kNodes[] = {20, 20, 20, 50, 50, 154, 500};
    const int n = k % 50 == 0 ? 500 : kNodes[random() % 6];
    Numerics numerics;
    numerics.tick_s = 6.25e-5;
    numerics.substeps = numerics.max_substeps = 1;
    Material material;
    material.friction = uniform(0.0, 0.6);
    Rod rod(material, numerics, Parts{false, true, true, false, false}, n);
    const double top = std::pow(10.0, uniform(-1.0, std::log10(50.0)));
    const double angle = k % 5 == 0 ? 0.0 : uniform(-1.5, 1.5);
    shape(rod, uniform(1e-3, 8e-3), angle, uniform(0.3, 1.0) * top, uniform(0.0, 1.0) * top, uniform(-0.5, 0.5) * top);
    const int steps = static_cast<int>(std::min(60.0, 20.0 + 0.01 / (top * numerics.tick_s)));
    for (int step = 0; step < steps; ++step) {
      const std::vector<Vec> before = rod.state().x;
      rod.tick();
      guarded += rod.report().guard_events > 0;
      ++substeps;
      const auto& after = rod.state().x;
      for (const auto& pair : rod.contact_set().pairs) {
        const auto a = static_cast<std::size_t>(pair.a), b = static_cast<std::size_t>(pair.b);
        found += crossed({before[a], before[a + 1], before[b], before[b + 1]},
                         {after[a], after[a + 1], after[b], after[b + 1]});
      }
    }
  }
  std::printf("approaches %ld, substeps %ld, guard acted in %ld, crossings %ld\n", approaches, substeps, guarded,
              found);
  return found == 0 ? 0 : 1;
}
