// Remeshing: no strand is cut, and momentum, length and the force on a hand are preserved.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/crossings.hpp"
#include "tests/support/random.hpp"
#include "tests/unit/rod/rods.hpp"

namespace ligature::test {
namespace {

// A wide helix whose turns pass close outside a straight strand of the same thread, and a tight coil, into which the
// adaptive mesh moves nodes. A merge replaces two segments of the helix by their chord; it would cut the strand where
// that runs between the two segments and the chord.
void helix_around_a_strand(Rod& rod, double phase, double inside_m) {
  constexpr double kRadius = 6.4e-3, kPitch = 4e-3, kTurns = 3.5, kCoil = 1.2e-3;
  std::vector<Vec> line;
  for (int i = 0; i <= 700; ++i) {
    const double turn = kTurns * i / 700.0, a = 2.0 * std::numbers::pi * turn;
    line.push_back(make(kRadius * std::cos(a), kRadius * std::sin(a), kPitch * turn));
  }
  const double r = kRadius - inside_m;
  const Vec foot = make(r * std::cos(phase), r * std::sin(phase), 0);
  for (const double z : {20e-3, -10e-3}) line.push_back(foot + make(0, 0, z));
  for (int i = 0; i <= 400; ++i) {
    const double a = 2.0 * std::numbers::pi * 4.0 * i / 400.0;
    line.push_back(foot + make(kCoil * (std::cos(a) - 1.0), kCoil * std::sin(a), -10e-3 - 1e-3 * 4.0 * i / 400.0));
  }
  std::vector<double> arc{0.0};
  for (std::size_t i = 1; i < line.size(); ++i) arc.push_back(arc.back() + norm(line[i] - line[i - 1]));
  State& state = rod.state();
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    state.x[i] = point_at(arc, line, state.mesh.s[i] / rod.material().length_m * arc.back());
  }
  rod.moved();
}

// The straight strand runs just inside the helix, in 60 random places: between the curve of the helix and the chord by
// which a merge would replace two of its segments. The thread must be remeshed, but no segment may cross the strand.
TEST(Remesh, CutsNothing) {
  test::Random random(3);
  const auto phase = [&] { return random.in(0.0, 2.0 * std::numbers::pi); };
  const auto inside = [&] { return random.in(1.12, 1.6); };
  long crossings = 0, remeshes = 0;
  for (int k = 0; k < 60; ++k) {
    Material m;
    m.length_m = 0.235;
    Rod rod(m, steps_of(1e-7), Parts{false, true, true, false, true}, 99);
    const double at = phase(), radius = inside() * 2.0 * m.radius_m;
    helix_around_a_strand(rod, at, radius);
    rod.hold_mesh(true);
    rod.tick();
    for (int i = 0; i < 10; ++i) {
      const std::vector<double> s = rod.state().mesh.s;
      const std::vector<Vec> x = rod.state().x;
      if (!rod.remesh()) break;
      ++remeshes;
      crossings += crossings_of_remesh(s, x, rod.state());
      rod.tick();
    }
  }
  EXPECT_GT(remeshes, 100);
  EXPECT_EQ(crossings, 0);
}

Vec momentum(const State& state) {
  Vec sum{};
  for (std::size_t i = 0; i < state.x.size(); ++i) sum += state.mesh.mass[i] * state.v[i];
  return sum;
}

constexpr double kHelix_m = 0.235;

/// A helix around a strand, which is remeshed in several of its first ticks.
Rod remeshed_helix() {
  Material m;
  m.length_m = kHelix_m;
  Numerics numerics;
  numerics.tick_s = 1e-4;
  numerics.substeps = numerics.max_substeps = 4;
  Rod rod(m, numerics, Parts{false, true, true, false, true}, 99);
  helix_around_a_strand(rod, 0.3, 1.3e-3);
  rod.hold_mesh(true);
  return rod;
}

TEST(Remesh, KeepsMomentumAndLength) {  // to rounding, in every remesh of a moving thread
  Rod rod = remeshed_helix();
  for (auto& v : rod.state().v) v = make(0.3, -0.2, 0.1);
  int remeshes = 0;
  for (int i = 0; i < 200; ++i) {
    rod.tick();
    const Vec before = momentum(rod.state());
    if (!rod.remesh()) continue;
    ++remeshes;
    EXPECT_LT(norm(momentum(rod.state()) - before), 1e-12 * norm(before));
    EXPECT_EQ(rod.state().mesh.s.front(), 0.0);
    EXPECT_NEAR(rod.state().mesh.s.back(), kHelix_m, 1e-15);
    double length = 0.0, mass = 0.0;
    for (std::size_t j = 0; j + 1 < rod.state().x.size(); ++j) length += rod.state().mesh.rest[j];
    for (const double k : rod.state().mesh.mass) mass += k;
    EXPECT_NEAR(length, kHelix_m, 1e-14);
    EXPECT_NEAR(mass, kHelix_m * rod.material().density_kg_per_m, 1e-17);
  }
  EXPECT_GT(remeshes, 5);
}

TEST(Remesh, KeepsTheLoads) {  // a node that carries a load stays
  Rod rod = remeshed_helix();
  int loads = 0, remeshes = 0;
  for (std::size_t i = 1; i + 1 < rod.state().load.size(); i += 3, ++loads) rod.state().load[i] = make(0, 0, -1e-9);
  for (int i = 0; i < 200; ++i) {
    rod.tick();
    remeshes += rod.remesh();
    double sum_N = 0.0;
    for (const Vec& load : rod.state().load) sum_N += load[2];
    ASSERT_NEAR(sum_N, -1e-9 * loads, 1e-18) << i;
  }
  EXPECT_GT(remeshes, 5);
}

// Remeshing stores stress-free bends, so that it changes no moment. They must fade, also in a thread that nobody holds:
// without weight and contact it ends straight, as all its bending energy is dissipated.
TEST(Remesh, LeavesNoBendInAThreadThatIsAlone) {
  Rod rod = remeshed_helix();
  rod.hold_mesh(false);
  int remeshes = 0;
  for (int i = 0; i < 20000; ++i) {
    rod.tick();
    remeshes += rod.report().remeshes;
  }
  EXPECT_GT(remeshes, 5);
  EXPECT_GT(norm(rod.state().x.back() - rod.state().x.front()), 0.99 * kHelix_m);
}

}  // namespace
}  // namespace ligature::test
