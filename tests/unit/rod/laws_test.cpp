// Contact and energy of the rod compared with closed forms: friction cone, moving belts, slow slip, impulses at
// rest, springs.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/random.hpp"
#include "tests/unit/rod/rods.hpp"

namespace ligature::test {
namespace {

using physics::rod::in_cone;

constexpr double kG = 9.81;

// Projection onto the friction cone: an impulse inside is unchanged; outside, its tangential part becomes mu times the
// normal part; a pulling one becomes zero.
TEST(Cone, KeepsTheNormalPartAndCutsTheRestToItsEdge) {
  test::Random random(31);
  const auto any = [&] { return random.in(-1.0, 1.0); };
  const auto vector = [&] {
    const double x = any(), y = any(), z = any();
    return make(x, y, z);
  };
  int cut = 0, kept = 0, pulls = 0;
  for (int k = 0; k < 5000; ++k) {
    const Vec p = vector(), aim = vector();
    if (norm(aim) < 0.1) continue;
    const Vec n = (1.0 / norm(aim)) * aim;
    const double mu = any() + 1.0, pn = dot(p, n);
    const Vec across = p - pn * n, q = in_cone(p, n, mu);
    const double size = norm(across);
    if (pn <= 0.0) {
      EXPECT_EQ(norm(q), 0.0);
      ++pulls;
      continue;
    }
    const double share = size > mu * pn ? mu * pn / size : 1.0;
    EXPECT_LE(norm(q - (pn * n + share * across)), 1e-12);
    share < 1.0 ? ++cut : ++kept;
  }
  EXPECT_GT(std::min({cut, kept, pulls}), 500);
}

// A thread lies across two moving belts: friction accelerates it at mu g until it has the belts' speed.
TEST(Belts, DrawTheThreadAlongByFrictionUntilItIsAsFast) {
  constexpr double kMu = 0.2, kBelt_m_per_s = 0.05, kRoll_m = 1e-3;
  Material m;
  m.length_m = 0.03;
  m.drag_per_s = 0.0;
  m.friction = kMu;
  Rod rod(m, Numerics{}, Parts{.twist = false, .contact = false, .friction = true, .world = true}, 31, 2);
  for (const double x : {0.007, 0.023}) {
    const double z = -kRoll_m - m.radius_m;
    rod.bodies.push_back({make(x, -0.02, z), make(x, 0.02, z), kRoll_m, make(0, kBelt_m_per_s, 0), kMu});
  }
  rod.moved();
  rod.gravity = make(0, 0, -kG);
  const auto mean = [&rod] {
    double sum = 0.0;
    for (const auto& v : rod.state().v) sum += v[1];
    return sum / static_cast<double>(rod.state().v.size());
  };
  for (int k = 0; k < 10; ++k) rod.tick();
  EXPECT_NEAR(mean(), kMu * kG * 0.01, 0.1 * kMu * kG * 0.01);
  for (int k = 0; k < 100; ++k) rod.tick();
  EXPECT_NEAR(mean(), kBelt_m_per_s, 0.01 * kBelt_m_per_s);
}

// A speed of 2e-4 m/s is still sliding: on a slope just steeper than the kinetic friction mu_k the thread must keep
// sliding, and static friction must not stop it.
TEST(StaticFriction, DoesNotCatchWhatSlidesSlowly) {
  constexpr double kSlide = 0.2, kSlow_m_per_s = 2e-4;
  Material m;
  m.length_m = 0.03;
  m.drag_per_s = 0.0;
  m.friction = kSlide;
  m.static_friction = 2.0 * kSlide;
  Rod rod(m, Numerics{}, Parts{.twist = false, .contact = false, .friction = true, .world = true}, 30);
  rod.has_floor = true;
  rod.floor_friction = kSlide;
  for (auto& x : rod.state().x) x += make(0, 0, m.radius_m);
  for (auto& v : rod.state().v) v = make(0, kSlow_m_per_s, 0);
  rod.moved();
  const double angle = std::atan(kSlide) + 1e-4, a = kG * (std::sin(angle) - kSlide * std::cos(angle));
  rod.gravity = make(0, kG * std::sin(angle), -kG * std::cos(angle));
  for (int k = 0; k < 100; ++k) rod.tick();
  EXPECT_NEAR(rod.state().v[15][1], kSlow_m_per_s + 0.1 * a, 0.5 * kSlow_m_per_s);
}

// At 5 m/s a thread that is 2.9 mm above a bar reaches it in 0.6 of a tick. The bar must be looked at again by then.
TEST(World, AFastThreadDoesNotPassThroughABar) {
  Material m;
  m.length_m = 0.03;
  Rod rod(m, Numerics{}, Parts{.twist = false, .contact = false, .friction = true, .world = true}, 31, 1);
  rod.bodies.push_back({make(0.015, -0.01, 0), make(0.015, 0.01, 0), 1e-3, Vec{}, 0.3, Vec{}});
  for (auto& x : rod.state().x) x += make(0, 0, 4e-3);
  for (auto& v : rod.state().v) v = make(0, 0, -5.0);
  rod.moved();
  rod.tick();
  EXPECT_GT(rod.state().x[15][2], 1.1e-3);
}

// Contacts at rest keep their forces, so their impulses are proportional to the time step. When a tick has eight
// substeps instead of sixteen, a heavy thread on a desk needs hardly more passes than later on: 14 instead of 12. With
// unchanged impulses it needs 101.
TEST(Impulses, AtRestAreProportionalToTheTimeStep) {
  Material m;
  m.length_m = 0.03;
  Rod rod(m, Numerics{}, Parts{.twist = false, .contact = false, .friction = true, .world = true}, 30);
  rod.has_floor = true;
  rod.gravity = make(0, 0, -981.0);
  for (auto& x : rod.state().x) x += make(0, 0, m.radius_m);
  rod.moved();
  for (int k = 0; k < 1000; ++k) rod.tick();
  ASSERT_EQ(rod.report().substeps, 16);
  rod.numerics().substeps = 8;
  rod.tick();
  const int first = rod.report().passes;
  for (int k = 0; k < 100; ++k) rod.tick();
  ASSERT_EQ(rod.report().substeps, 8);
  RecordProperty("first", first);
  RecordProperty("later", rod.report().passes);
  EXPECT_LE(first, 2 * rod.report().passes);
}

// At rest on a desk the contacts carry the weight. A contact with force F and stiffness k stores F^2 / 2k.
TEST(Energy, TheGiveOfContactsIsThatOfTheirSprings) {
  Material m;
  m.length_m = 0.03;
  Numerics soft;
  soft.contact_N_per_m = 10.0;
  Rod rod(m, soft, Parts{.twist = false, .contact = false, .friction = true, .world = true}, 30);
  rod.has_floor = true;
  for (auto& x : rod.state().x) x += make(0, 0, m.radius_m);
  rod.moved();
  const double heavy = 100.0 * kG;
  rod.gravity = make(0, 0, -heavy);
  for (int k = 0; k < 1000; ++k) rod.tick();
  const double per_second = rod.report().substeps / soft.tick_s;
  double stored_J = 0.0, pressed_N = 0.0;
  for (const auto& c : rod.contact_set().contacts()) {
    const double force_N = per_second * dot(c.p, c.n);
    pressed_N += force_N;
    stored_J += 0.5 * force_N * force_N / soft.contact_N_per_m;
  }
  const double weight_N = m.density_kg_per_m * m.length_m * heavy;
  EXPECT_NEAR(pressed_N, weight_N, 1e-3 * weight_N);
  const auto e = rod.energy();
  EXPECT_NEAR(e.give_J, stored_J, 1e-3 * stored_J);
  EXPECT_NEAR(rod.all_J(e), e.kinetic_J + e.stretch_J + e.bend_J + e.gravity_J + e.give_J, 1e-3 * stored_J);
}

// A rod between a fixed end and a hand's spring, stretched and twisted, under a constant load. Energy: T^2 / 2K of the
// spring + T^2 L / 2EA of stretch + C phi^2 / 2L of twist - F x of the load (T tension, C twist stiffness, phi end
// rotation, F load, x its shift).
TEST(Energy, AllOfItIsTheSumOfItsSprings) {
  constexpr double kSpring_N_per_m = 50.0, kPull_N = 20.0, kTurn = 0.5, kLoad_N = 5.0;
  for (const bool rolls : {false, true}) {
    Material m = unit_rod();
    m.EA_N = 1e3;
    m.EI_N_m2 = 1e-6;  // a clamp's bending moment depends on stretch, too; with this value it is negligible
    m.stretch_tau_s = m.bend_tau_s = 0.01;
    m.drag_per_s = 10.0;
    const Parts parts{
        .twist = true, .contact = false, .friction = false, .world = false, .adaptive = false, .roll = rolls};
    Rod rod(m, steps_of(1e-3), parts, 21);
    rod.clamp(0, make(0, 0, 0), make(1, 0, 0));
    const int end = rod.grip(20, kSpring_N_per_m, 1.0, make(1, 0, 0));
    rod.state().load[20] = make(kLoad_N, 0, 0);
    const double long_m = 1.0 + (kPull_N + kLoad_N) / m.EA_N;
    auto& hold = rod.state().holds[static_cast<std::size_t>(end)];
    hold.target = make(long_m + kPull_N / kSpring_N_per_m, 0, 0);
    for (int k = 0; k < 100; ++k) {
      Twist::roll(hold, kTurn / 100);
      rod.tick();
    }
    for (int k = 0; k < 6000; ++k) rod.tick();
    const double tension_N = kPull_N + kLoad_N, stretch_J = 0.5 * tension_N * tension_N / m.EA_N,
                 twist_J = 0.5 * m.GJ_N_m2 * kTurn * kTurn, spring_J = 0.5 * kPull_N * kPull_N / kSpring_N_per_m;
    EXPECT_NEAR(rod.energy().stretch_J, stretch_J, 1e-5 * stretch_J);
    EXPECT_NEAR(rod.twist_energy_J(), twist_J, 2e-3 * twist_J) << rolls;
    EXPECT_NEAR(rod.all_J(rod.energy()), spring_J + stretch_J + twist_J - kLoad_N * long_m, 1e-4) << rolls;
  }
}

}  // namespace
}  // namespace ligature::test
