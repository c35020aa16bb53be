// Roll, the rotation of segments about the thread's axis: of threads with a curved rest shape, and of threads that
// friction makes roll.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/rod/rods.hpp"

namespace ligature::test {
namespace {

constexpr double kG = 9.81;
constexpr Parts kRolling{
    .twist = true, .contact = false, .friction = false, .world = false, .adaptive = false, .roll = true};
constexpr Parts kOnADesk{
    .twist = true, .contact = true, .friction = true, .world = true, .adaptive = false, .roll = true, .turning = true};

/// Radius of the circle through three points.
double radius_through(Vec a, Vec b, Vec c) {
  const double twice_area = norm(cross(b - a, c - a));
  return norm(b - a) * norm(c - b) * norm(a - c) / (2.0 * twice_area);
}

Material nylon(double length_m) {
  Material m;
  m.length_m = length_m;
  m.drag_per_s = 30.0;
  return m;
}

// Package memory: a free thread curls to the radius on which it was wound. A perfectly straight start would have no
// preferred direction.
TEST(RestCurvature, AFreeThreadRelaxesToACircularArc) {
  for (const int nodes : {30, 60}) {
    Material m = nylon(0.06);
    m.born_curvature_per_m = 50.0;
    Rod rod(m, Numerics{}, kRolling, nodes);
    for (int k = 0; k < 3000; ++k) rod.tick();
    const auto& x = rod.state().x;
    const std::size_t n = x.size();
    for (std::size_t i = n / 6; i < n - n / 6 - 4; i += 2)
      EXPECT_NEAR(radius_through(x[i], x[i + 2], x[i + 4]), 0.02, 0.005 * 0.02) << nodes << " nodes, at " << i;
    // 0.06 m on a radius of 0.02 m is an arc of 3 rad; its chord is compared.
    EXPECT_NEAR(norm(x[n - 1] - x[0]), 2.0 * 0.02 * std::sin(1.5), 0.005 * 0.04);
    EXPECT_LT(rod.energy().bend_J + rod.twist_energy_J(), 1e-6 * 0.5 * m.EI_N_m2 * 50.0 * 50.0 * 0.06);
  }
}

// The caller may move the thread any number of times before it begins, as a scene with fixed nodes does.
TEST(RestCurvature, CountsOnceHoweverOftenTheThreadIsMoved) {
  Material m = nylon(0.06);
  m.born_curvature_per_m = 50.0;
  Rod rod(m, Numerics{}, kRolling, 30);
  const auto once = rod.state().rest_bend;
  ASSERT_GT(norm(once[15]), 0.09);  // 50/m x 0.06 m / 29
  rod.moved();
  rod.moved();
  for (std::size_t i = 0; i < once.size(); ++i) EXPECT_LT(norm(rod.state().rest_bend[i] - once[i]), 1e-15) << i;
}

// As a live change of a scene's parameter does: a thread that has run without rest curvature gets one, and loses it.
TEST(RestCurvature, CountsWhenItIsSetInARunningThread) {
  Material m = nylon(0.06);
  Rod straight(m, Numerics{}, Parts{.twist = true, .contact = false, .friction = false}, 30);
  straight.tick();
  m.born_curvature_per_m = 50.0;
  Rod curved(m, Numerics{}, kRolling, 30);
  const auto born = curved.state().rest_bend;
  ASSERT_TRUE(curved.continue_from(straight));
  for (std::size_t i = 0; i < born.size(); ++i)
    EXPECT_NEAR(norm(curved.state().rest_bend[i]), norm(born[i]), 1e-12) << i;
  curved.tick();
  ASSERT_TRUE(straight.continue_from(curved));
  for (const Vec& bend : straight.state().rest_bend) EXPECT_LT(norm(bend), 1e-12);
}

// Rest curvature k about an axis that rotates by t per length gives a helix of radius k / (k^2 + t^2).
TEST(RestCurvature, WithARestTwistAFreeThreadRelaxesToAHelix) {
  Material m = nylon(0.06);
  m.born_curvature_per_m = 60.0;
  m.born_twist_per_m = 80.0;
  Rod rod(m, Numerics{}, kRolling, 80);
  for (int k = 0; k < 4000; ++k) rod.tick();
  const auto& x = rod.state().x;
  // Squared chord of an arc s of a helix: (2 a sin(w s / 2))^2 + (b w s)^2 with
  // w^2 = k^2 + t^2, a = k / w^2, b = t / w^2.
  const double w = std::hypot(60.0, 80.0), a = 60.0 / (w * w), rise = 80.0 / w;
  for (const std::size_t span : {20U, 40U, 60U}) {
    const double s = 0.06 * static_cast<double>(span) / 79.0;
    const double chord = std::hypot(2.0 * a * std::sin(0.5 * w * s), rise * s);
    EXPECT_NEAR(norm(x[10 + span] - x[10]), chord, 0.005 * chord) << span;
  }
}

// A rod of length L whose ends are clamped, roll included, and turned against each other by an angle has the twisting
// moment C angle / L (C twist stiffness).
TEST(Spin, TurnedEndsTwistEvenly) {
  Material m = unit_rod();
  m.GJ_N_m2 = 0.8;
  m.bend_tau_s = 0.01;
  Rod rod(m, steps_of(1e-3), kRolling, 41);
  rod.clamp(0, make(0, 0, 0), make(1, 0, 0));
  const int end = rod.clamp(40, make(1, 0, 0), make(1, 0, 0));
  for (int k = 0; k < 400; ++k) {
    if (k < 100) Twist::roll(rod.state().holds[static_cast<std::size_t>(end)], 0.02);
    rod.tick();
  }
  for (const std::size_t i : {1U, 20U, 39U}) EXPECT_NEAR(rod.forces().twist_moment[i], 0.8 * 2.0, 1e-3 * 1.6);
}

/// A thread at rest along x, on a desk at z = 0.
Rod on_a_desk(const Material& material, int nodes) {
  Rod rod(material, Numerics{}, kOnADesk, nodes, 1);
  rod.has_floor = true;
  rod.floor_friction = material.friction;
  for (auto& x : rod.state().x) x += make(0, 0, material.radius_m);
  rod.moved();
  return rod;
}

// A cylinder across a slope, with the moment of inertia m r^2 / 2, accelerates at 2/3 g sin(angle) as long as friction
// suffices to roll it.
TEST(Turning, AThreadRollsDownASlopeAtTwoThirds) {
  Material m = nylon(0.03);
  m.drag_per_s = 0.0;
  m.friction = 0.3;
  Rod rod = on_a_desk(m, 30);
  const double slope = 0.2;  // rad; rolling without slip needs tan(angle) < 3 mu
  rod.gravity = make(0, kG * std::sin(slope), -kG * std::cos(slope));
  for (int k = 0; k < 100; ++k) rod.tick();
  const auto& s = rod.state();
  EXPECT_NEAR(s.v[15][1], 2.0 / 3.0 * kG * std::sin(slope) * 0.1, 0.01 * 2.0 / 3.0 * kG * std::sin(slope) * 0.1);
  EXPECT_NEAR(std::abs(rod.spin().rate(15)) * m.radius_m, s.v[15][1], 0.01 * s.v[15][1]);  // rolls without slip
}

// On a slope steeper than 3 mu the thread slips and rolls: acceleration g (sin - mu cos), angular acceleration 2 mu g
// cos / r.
TEST(Turning, TooSteepItSlipsWhileItRolls) {
  Material m = nylon(0.03);
  m.drag_per_s = 0.0;
  m.friction = 0.1;
  Rod rod = on_a_desk(m, 30);
  const double slope = 0.6;
  rod.gravity = make(0, kG * std::sin(slope), -kG * std::cos(slope));
  for (int k = 0; k < 100; ++k) rod.tick();
  const double along = kG * (std::sin(slope) - 0.1 * std::cos(slope)) * 0.1;
  EXPECT_NEAR(rod.state().v[15][1], along, 0.01 * along);
  EXPECT_NEAR(std::abs(rod.spin().rate(15)) * m.radius_m, 2.0 * 0.1 * kG * std::cos(slope) * 0.1,
              0.02 * 0.2 * kG * 0.1);
}

// A thread fixed in line at both ends, pressed on the desk and spun at one end: the torque is mu N r.
TEST(Turning, SpinningUnderALoadTakesMuNR) {
  Material m = nylon(0.02);
  m.EI_N_m2 = 4e-6;  // stiff enough to stay in line although the desk pushes it sideways by mu N
  m.friction = 0.3;
  Rod rod = on_a_desk(m, 21);
  const int turner = rod.clamp(0, rod.state().x[0], make(1, 0, 0));
  for (std::size_t i = 1; i < 20; ++i) rod.state().load[i] = make(0, 0, -0.01);
  rod.support(20, rod.state().x[20]);
  double torque = 0.0, normal = 0.0;
  for (int k = 0; k < 400; ++k) {
    Twist::roll(rod.state().holds[static_cast<std::size_t>(turner)], 0.05);  // 50 rad/s: 7.5 mm/s at the surface
    rod.tick();
    if (k < 200) continue;
    torque += std::abs(rod.forces().twist_moment[0]) / 200.0;
    for (const auto& c : rod.contact_set().contacts()) normal += dot(c.p, c.n) * rod.contact_set().per_second() / 200.0;
  }
  EXPECT_GT(normal, 0.15);
  EXPECT_NEAR(torque, m.friction * normal * m.radius_m, 0.02 * m.friction * normal * m.radius_m);
}

}  // namespace
}  // namespace ligature::test
