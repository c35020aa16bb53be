// Contact laws of the paper of 2007 as pure functions, as printed and with our corrections: equations (1)-(3),
// (18)-(22) and the separation of section V.A.
#include <gtest/gtest.h>

#include "firmware/physics/paper/contact_row.hpp"
#include "firmware/physics/paper/friction.hpp"
#include "firmware/physics/paper/repulsion.hpp"
#include "firmware/physics/paper/separation.hpp"
#include "tests/unit/physics/random_states.hpp"

namespace ligature::physics {
namespace {

using test::V;

TEST(Repulsion, PushesWhenOverlappingAndNeverPullsWhenClamped) {
  const Repulsion k;
  EXPECT_DOUBLE_EQ(repulsion_N(k, 0.05, 0.08, 0.0), 2.0);
  EXPECT_DOUBLE_EQ(repulsion_N(k, 0.05, 0.08, -1.0), 7.0);
  EXPECT_DOUBLE_EQ(repulsion_N(k, 0.05, 0.08, 1.0), 0.0);  // separating: without the clamp the damper would pull
  EXPECT_DOUBLE_EQ(repulsion_N(k, 0.05, 0.08, 1.0, false), -3.0);  // as printed
}

TEST(CoulombFriction, PointsAgainstTheSlipWithMuTimesTheNormalForce) {
  test::Random random(1);
  for (int k = 0; k < 2000; ++k) {
    const V v = random.vector(), n = (1.0 / norm(v)) * random.vector();
    const V normal = (1.0 / norm(n)) * n;
    const V f = coulomb_friction_N(0.3, 2.0, v, normal);
    EXPECT_NEAR(norm(f), 0.6, 1e-12);
    EXPECT_NEAR(dot(f, normal), 0.0, 1e-12);
    EXPECT_LE(dot(f, v), 0.0);
  }
  EXPECT_EQ(norm(coulomb_friction_N(0.3, 2.0, {0, 0, 1}, {0, 0, 1})), 0.0);  // no slip, no 0/0
}

TEST(CappedFriction, StopsSlipButNeverReversesIt) {
  test::Random random(2);
  for (int k = 0; k < 2000; ++k) {
    const V v = random.vector(), normal = {0, 0, 1};
    const double m = random.log_in(1e-3, 1e3), i = random.log_in(1e-3, 1e3), mu = random.in(0.0, 10.0);
    const V after = v + (1.0 / m) * capped_friction_N_s(mu, 0.8 * mu, i, m, v, normal);
    EXPECT_GE(dot(slip_velocity(after, normal), slip_velocity(v, normal)), -1e-12);
    EXPECT_LE(norm(slip_velocity(after, normal)), norm(slip_velocity(v, normal)) + 1e-12);
    EXPECT_LE(m * norm(after - v), std::max(mu, 0.8 * mu) * i * (1 + 1e-12));
  }
}

TEST(ImpulseResponse, ConservesBothMomentaAndGivesOneToTwoTimesTheImpulse) {
  test::Random random(3);
  for (int k = 0; k < 2000; ++k) {
    const auto s = random.nodes(4);
    const double a = random.in(0, 1), b = random.in(0, 1), i = random.in(0, 1), m = random.in(0.01, 1);
    const V n = (1.0 / norm(s.p[0])) * s.p[0];
    const Shares share = shares(a, b);
    const double part[4] = {share.a, share.b, share.c, share.d};
    const double applied = bridson_impulse_N_s(i, a, b);
    EXPECT_GE(applied, i * (1 - 1e-12));
    EXPECT_LE(applied, 2 * i * (1 + 1e-12));
    V linear{0, 0, 0}, angular{0, 0, 0};
    for (std::size_t e = 0; e < 4; ++e) {
      const V change = velocity_after(s.v[e], part[e], applied, 1.0 / m, n) - s.v[e];
      linear = linear + m * change, angular = angular + m * cross(s.p[e], change);
    }
    // Opposite impulses act at the points C and E of the two segments. In a contact, C and E differ only along n, so
    // the impulses exert no torque. Here the points are arbitrary, and the torque must be that of the two impulses.
    const V c = (1 - a) * s.p[0] + a * s.p[1], e = (1 - b) * s.p[2] + b * s.p[3];
    EXPECT_LE(norm(linear), 1e-12);
    EXPECT_LE(norm(angular - cross(c - e, applied * n)), 1e-12);
  }
}

TEST(Separation, OpensTheGapToTheSafetyMarginAndKeepsTheCentreOfMass) {
  test::Random random(4);
  for (int k = 0; k < 2000; ++k) {
    const double a = random.in(0, 1), b = random.in(0, 1), d = random.in(0, 0.1), eps = 1e-3;
    const Shares s = shares(a, b), w{20, 20, 20, 20};
    const double each = separation_m(0.05, d, eps);
    const Shares f = separating_shifts(each, s, w);
    EXPECT_NEAR(s.a * f.a + s.b * f.b + s.c * f.c + s.d * f.d, 0.1 - d + eps,
                1e-12);  // C moves away from E by this much
    EXPECT_NEAR(f.a + f.b + f.c + f.d, 0.0, 1e-12);
  }
  EXPECT_EQ(separation_m(0.05, 0.11, 1e-3), 0.0);
}

// Projection onto the friction cone: sticking inside, sliding outside, and zero where the contact would pull.
TEST(FrictionCone, SticksInsideSlidesOutsideAndNeverPulls) {
  const Pack n{0, 0, 1, 0};
  const Pack inside = project_on_cone(Pack{0.2, 0, 1, 0}, n, 0.3, 0.25);
  EXPECT_DOUBLE_EQ(inside[0], 0.2);
  const Pack outside = project_on_cone(Pack{0.4, 0, 1, 0}, n, 0.3, 0.25);
  EXPECT_DOUBLE_EQ(outside[0], 0.25);
  EXPECT_DOUBLE_EQ(outside[2], 1.0);
  const Pack pulled = project_on_cone(Pack{0.4, 0, -1, 0}, n, 0.3, 0.25);
  EXPECT_DOUBLE_EQ(pulled[0], 0.0);
  EXPECT_DOUBLE_EQ(pulled[2], 0.0);
}

}  // namespace
}  // namespace ligature::physics
