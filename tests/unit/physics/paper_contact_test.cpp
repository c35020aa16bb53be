// PaperContact, the self-contact of the paper of 2007, compared with closed forms for random crossings: the equations
// (2), (18)-(22) for the normal direction, (1) and (3) for friction, and the separation of section V.A.
#include "firmware/physics/paper/paper_contact.hpp"

#include <gtest/gtest.h>

#include "tests/unit/physics/random_thread.hpp"

namespace ligature::physics {
namespace {

using test::kinetic_J;
using test::V;

constexpr double kSafety = 0.01;  // gap that the separation leaves between two surfaces, as a share of the radius

/// Four nodes whose first and third segments cross and overlap; the second segment joins them.
struct Crossing {
  test::Thread t;
  V n;           // unit vector from the third segment to the first
  double a, b;   // positions of the crossing along the two segments
  double gap_m;  // negative: overlap
  double part[4], mobility_per_kg = 0.0;

  explicit Crossing(test::Random& random) : t(test::random_thread(4, random)) {
    n = random.unit();
    const V along = random.unit(), d1 = (1.0 / norm(cross(n, along))) * cross(n, along), side = cross(n, d1);
    const double turn = random.in(0.5, 2.6), l1 = random.in(0.2, 0.5), l2 = random.in(0.2, 0.5);
    const V d2 = std::cos(turn) * d1 + std::sin(turn) * side, c = random.vector();
    a = random.in(0.1, 0.9), b = random.in(0.1, 0.9);
    const double distance_m = 2.0 * t.m.radius_m * random.in(0.02, 0.999);
    gap_m = distance_m - 2.0 * t.m.radius_m;
    const V e = c - distance_m * n;
    t.s.p.put(0, c - (a * l1) * d1), t.s.p.put(1, c + ((1.0 - a) * l1) * d1);
    t.s.p.put(2, e - (b * l2) * d2), t.s.p.put(3, e + ((1.0 - b) * l2) * d2);
    part[0] = 1.0 - a, part[1] = a, part[2] = b - 1.0, part[3] = -b;
    for (int k = 0; k < 4; ++k) mobility_per_kg += part[k] * part[k] / t.m.mass_kg;
  }
  /// Difference of a nodal quantity between first and third segment at the crossing.
  V relative(const Lane3& of) const {
    V u{0, 0, 0};
    for (int k = 0; k < 4; ++k) u = u + part[k] * of.at(k);
    return u;
  }
  /// Repulsion by the paper's equation (2), N; negative: attraction.
  double repulsion() const { return -100.0 * gap_m - 5.0 * dot(relative(t.s.v), n); }
  /// Impulse of a repulsion of force_N in one step by the paper's equation (18), N s.
  double impulse(double force_N) const {
    return 2.0 * force_N * t.m.step_s / (a * a + b * b + (1 - a) * (1 - a) + (1 - b) * (1 - b));
  }
  void solve(double stick, double slip, bool capped) {
    PaperContact contact(t.m, {{100.0, 5.0}, stick, slip, 2, capped});
    contact.solve(t.m, t.s);
    ASSERT_EQ(contact.active(), 1);
    ASSERT_NEAR(contact.min_gap_m(), gap_m, 1e-12);
  }
};
V across(const V& u, const V& n) { return u - dot(u, n) * n; }

TEST(PaperContact, PushesApartByTheImpulseOfItsRepulsion) {
  test::Random random(21);
  int pushed = 0;
  for (int k = 0; k < 2000; ++k) {
    Crossing x(random);
    const V before = x.relative(x.t.s.v);
    const double force_N = std::max(0.0, x.repulsion());  // contact never pulls
    x.solve(0.3, 0.2, true);
    const double gained = dot(x.relative(x.t.s.v) - before, x.n);
    EXPECT_NEAR(gained, x.impulse(force_N) * x.mobility_per_kg, 1e-12 + 1e-9 * gained);
    pushed += gained > 0.0;
  }
  EXPECT_GT(pushed, 1000);
}

TEST(PaperContact, FrictionStopsSlipInsideTheStaticConeAndBrakesItByTheKineticOneBeyond) {
  test::Random random(22);
  int stuck = 0, slid = 0;
  for (int k = 0; k < 2000; ++k) {
    Crossing x(random);
    const double slip = random.log_in(0.01, 10.0), stick = slip * random.in(1.0, 1.5);
    const V before = across(x.relative(x.t.s.v), x.n);
    const double room = x.impulse(std::max(0.0, x.repulsion())) * x.mobility_per_kg, speed = norm(before);
    const bool sticks = speed <= stick * room;
    x.solve(stick, slip, true);
    const V after = across(x.relative(x.t.s.v), x.n);
    const double left = sticks ? 0.0 : std::max(0.0, speed - slip * room);
    EXPECT_LE(norm(after - (left / speed) * before), 1e-9 * (1.0 + speed));
    sticks ? ++stuck : slid += room > 0.0;
  }
  EXPECT_GT(stuck, 100);
  EXPECT_GT(slid, 100);
}

// Without friction_cap, as the paper prints it: a friction impulse mu |N| dt (N normal force) acts against the slip,
// even if it reverses the slip. An attracting normal force, N < 0, acts as a repulsion |N|.
TEST(PaperContact, UncappedItIsAsPrinted) {
  test::Random random(23);
  int reversed = 0, attracted = 0;
  for (int k = 0; k < 2000; ++k) {
    Crossing x(random);
    const double mu = random.log_in(0.01, 100.0), force_N = x.repulsion();
    const V before = x.relative(x.t.s.v), slip = across(before, x.n);
    x.solve(mu, mu, false);
    const V after = x.relative(x.t.s.v);
    EXPECT_NEAR(dot(after - before, x.n), x.impulse(std::abs(force_N)) * x.mobility_per_kg, 1e-9);
    const double braked = mu * std::abs(force_N) * x.t.m.step_s * x.mobility_per_kg;
    EXPECT_LE(norm(across(after, x.n) - (1.0 - braked / norm(slip)) * slip), 1e-9 * (1.0 + braked));
    reversed += braked > norm(slip);
    attracted += force_N < 0.0;
  }
  EXPECT_GT(reversed, 100);
  EXPECT_GT(attracted, 100);
}

TEST(PaperContact, ConservesMomentumAndItsFrictionTakesEnergyOut) {
  test::Random random(24);
  for (int k = 0; k < 2000; ++k) {
    Crossing x(random);
    V before, after, unused;
    test::momenta(x.t, before, unused);
    Crossing smooth = x;
    const double mu = random.log_in(0.01, 10.0);
    x.solve(mu, mu, true);
    smooth.solve(0.0, 0.0, true);
    test::momenta(x.t, after, unused);
    EXPECT_LE(norm(after - before), 1e-12);
    EXPECT_LE(kinetic_J(x.t), kinetic_J(smooth.t) * (1 + 1e-12));
  }
}

TEST(PaperContact, SeparatesToItsMarginAndLeavesTheCentreOfMassAndFixedNodes) {
  test::Random random(25);
  for (int k = 0; k < 2000; ++k) {
    Crossing x(random);
    const int fixed = k % 5;  // node without mobility; 4: none
    if (fixed < 4) x.t.m.inverse_mass_per_kg[fixed] = 0.0;
    const Lane3 p = x.t.s.p, v = x.t.s.v;
    x.solve(0.3, 0.2, true);
    EXPECT_NEAR(dot(x.relative(x.t.s.p), x.n), (2.0 + kSafety) * x.t.m.radius_m, 1e-12);
    V moved{0, 0, 0};
    for (int i = 0; i < 4; ++i) moved = moved + (x.t.s.p.at(i) - p.at(i));
    if (fixed == 4) {
      EXPECT_LE(norm(moved), 1e-12);
    } else {
      EXPECT_EQ(norm(x.t.s.p.at(fixed) - p.at(fixed)), 0.0);
      EXPECT_EQ(norm(x.t.s.v.at(fixed) - v.at(fixed)), 0.0);
    }
  }
}

TEST(PaperContact, LeavesSegmentsThatAreApartAlone) {
  test::Random random(26);
  for (int k = 0; k < 500; ++k) {
    Crossing x(random);
    for (const int i : {0, 1}) x.t.s.p.put(i, x.t.s.p.at(i) + (1e-9 - x.gap_m) * x.n);
    const Lane3 p = x.t.s.p, v = x.t.s.v;
    PaperContact contact(x.t.m, {{100.0, 5.0}, 0.3, 0.2, 2, true});
    contact.solve(x.t.m, x.t.s);
    EXPECT_EQ(contact.active(), 0);
    for (int i = 0; i < 4; ++i) {
      EXPECT_EQ(norm(x.t.s.p.at(i) - p.at(i)), 0.0);
      EXPECT_EQ(norm(x.t.s.v.at(i) - v.at(i)), 0.0);
    }
  }
}

}  // namespace
}  // namespace ligature::physics
