// Tests the guarantee that strands never pass through each other. The arms of a hairpin are thrown at each other at up
// to 50 m/s each, at random angles (parallel and grazing included), sizes and node counts. In half of the cases the
// arms cross, or one end lies above the other arm. In every substep all pairs of segments are checked for a crossing
// (tests/support/crossings.hpp), not only those on the contact list.
//
// A third of the threads are adaptive. There remeshing also moves nodes between substeps, so the straight motion of
// every material point from the old to the new polyline is checked as well.
//
// Usage: rod_swept_attack [approaches = 10000] [seed = 1] [none]. `none` switches contact off, to show that crossings
// are then found. Prints the number of crossings; exit code 1 if any.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <numbers>

#include "firmware/physics/rod/rod.hpp"
#include "tests/support/crossings.hpp"
#include "tests/support/random.hpp"

using namespace ligature::physics::rod;
using ligature::test::crossings_of_remesh;
using ligature::test::crossings_of_step;

namespace {

// A hairpin: arm 1 along x, a half circle upwards, and arm 2 back, turned about z by `angle`.
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

// Like shape(), but the arms cross as seen from above: arm 1 along x, a step sideways and up, and arm 2 back across arm
// 1; with `end_on` the end of arm 2 is right above arm 1.
void shape_across(Rod& rod, double gap, double aside, bool end_on, double speed1, double speed2, double sideways) {
  State& state = rod.state();
  const double step = std::hypot(gap, aside), arm = (end_on ? 0.65 : 0.5) * (rod.material().length_m - step);
  const double back = rod.material().length_m - step - arm;
  const double slope = end_on ? aside / back : std::clamp(2.0 * aside / arm, -0.9, 0.9),
               along = std::sqrt(1.0 - slope * slope);
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    const double s = state.mesh.s[i], t = s - arm - step;
    if (s < arm) {
      state.x[i] = make(s, 0, 0);
      state.v[i] = make(0, 0, speed1);
    } else if (t < 0.0) {
      state.x[i] = make(arm, aside * (s - arm) / step, gap * (s - arm) / step);
    } else {
      state.x[i] = make(arm - t * along, aside - t * slope, gap);
      state.v[i] = make(sideways, sideways, -speed2);
    }
  }
  rod.moved();
}

}  // namespace

int main(int argc, char** argv) {
  const long approaches = argc > 1 ? std::atol(argv[1]) : 10000;
  ligature::test::Random random(argc > 2 ? static_cast<unsigned>(std::atoi(argv[2])) : 1U);
  const bool contact = argc < 4;
  const auto uniform = [&](double a, double b) { return random.in(a, b); };
  long found = 0, cut = 0, remeshes = 0, guarded = 0, substeps = 0;
  for (long k = 0; k < approaches; ++k) {
    static constexpr int kNodes[] = {20, 20, 20, 50, 50, 154};
    const int n = k % 50 < 3 ? 500 : kNodes[random() % 6];  // large meshes in 3 of 50 cases
    Numerics numerics;
    numerics.tick_s = 6.25e-5;
    numerics.substeps = numerics.max_substeps = 1;
    Material material;
    material.friction = uniform(0.0, 0.6);
    const bool adaptive = k % 3 == 0;
    const int nodes = adaptive ? std::clamp(n, 80, 200) : n;
    Rod rod(material, numerics, Parts{false, contact, contact, false, adaptive}, nodes);
    rod.hold_mesh(true);
    const double top = std::pow(10.0, uniform(-1.0, std::log10(50.0)));
    const double angle = k % 5 == 0 ? 0.0 : uniform(-1.5, 1.5);
    const double gap = uniform(1e-3, 8e-3), speed1 = uniform(0.3, 1.0) * top, speed2 = uniform(0.0, 1.0) * top;
    const double sideways = uniform(-0.5, 0.5) * top;
    if (k % 2 == 0) {
      shape(rod, gap, angle, speed1, speed2, sideways);
    } else {
      shape_across(rod, gap, uniform(2e-3, 0.05) * (k % 4 == 1 ? 1.0 : -1.0), k % 7 == 0, speed1, speed2, sideways);
    }
    const int steps = static_cast<int>(std::min(60.0, 20.0 + 0.01 / (top * numerics.tick_s)));
    for (int step = 0; step < steps; ++step) {
      if (adaptive) {
        const std::vector<double> s = rod.state().mesh.s;
        const std::vector<Vec> x = rod.state().x;
        if (rod.remesh()) ++remeshes, cut += crossings_of_remesh(s, x, rod.state());
      }
      const std::vector<Vec> before = rod.state().x;
      rod.tick();
      guarded += rod.report().guard_events > 0;
      ++substeps;
      found += crossings_of_step(before, rod.state().x);
    }
  }
  std::printf("approaches %ld, substeps %ld, guard acted in %ld, crossings %ld; remeshes %ld, crossings in them %ld\n",
              approaches, substeps, guarded, found, remeshes, cut);
  return found + cut == 0 ? 0 : 1;
}
