// The linkage's kinematics compared with geometry, finite differences and virtual work.
#include "firmware/control/kinematics.hpp"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/support/random.hpp"

namespace ligature::control {
namespace {

constexpr double kUpperArm_m = 0.134, kForearm_m = 0.1325;

Linkage arm() { return Linkage(device::omni()); }

std::vector<JointAngles> poses() {
  test::Random random(11);
  const auto q1 = [&] { return random.in(-0.9, 0.9); };
  const auto q2 = [&] { return random.in(0.0, 1.7); };
  const auto bend = [&] { return random.in(-0.8, 1.2); };
  std::vector<JointAngles> all;
  for (int i = 0; i < 200; ++i) {
    const double shoulder = q2();
    all.push_back({q1(), shoulder, shoulder + bend()});
  }
  return all;
}

TEST(Kinematics, UpperArmLevelAndForearmHangingIsReadOffTheDrawing) {
  const Vec3 p = arm().position({0.0, 0.0, 0.0});
  EXPECT_NEAR(p.x(), 0.0, 1e-15);
  EXPECT_NEAR(p.y(), -kUpperArm_m, 1e-15);  // -y points towards the operator
  EXPECT_NEAR(p.z(), -kForearm_m, 1e-15);
}

TEST(Kinematics, StretchedArmReachesTheSumOfTheLinks) {
  const Vec3 p = arm().position({0.0, 0.0, std::numbers::pi / 2});
  EXPECT_NEAR(p.norm(), kUpperArm_m + kForearm_m, 1e-15);
}

TEST(Kinematics, ForearmAngleIsAbsolute) {  // moving the shoulder alone translates the forearm without rotating it
  const JointAngles a{0.0, 0.2, 0.7}, b{0.0, 0.9, 0.7};
  const Vec3 shift = arm().position(b) - arm().position(a);
  EXPECT_NEAR(shift.y(), -kUpperArm_m * (std::cos(0.9) - std::cos(0.2)), 1e-15);
  EXPECT_NEAR(shift.z(), kUpperArm_m * (std::sin(0.9) - std::sin(0.2)), 1e-15);
}

TEST(Kinematics, TurningTheWaistLeftMovesTheTipAlongX) { EXPECT_GT(arm().position({0.1, 0.3, 0.5}).x(), 0.0); }

TEST(Kinematics, JacobianIsTheDerivative) {  // central difference with step ~ eps^(1/3), error ~ eps^(2/3)
  constexpr double h = 6e-6;
  for (const JointAngles& q : poses()) {
    const Mat3 J = arm().jacobian(q);
    for (std::size_t j = 0; j < 3; ++j) {
      JointAngles above = q, below = q;
      above[j] += h;
      below[j] -= h;
      const Vec3 difference = (arm().position(above) - arm().position(below)) / (2 * h);
      EXPECT_LT((J.col(static_cast<Eigen::Index>(j)) - difference).norm(), 1e-10);
    }
  }
}

TEST(Kinematics, JointTorqueDoesTheWorkOfTheForce) {  // tau . dq = f . dp for any small motion
  test::Random random(12);
  const auto any = [&] { return random.normal(); };
  for (const JointAngles& q : poses()) {
    const Vec3 f{any(), any(), any()}, dq{any(), any(), any()};
    const Vec3 dp = arm().jacobian(q) * dq;
    EXPECT_NEAR(arm().torque(q, f).dot(dq), f.dot(dp), 1e-12);
  }
}

TEST(Kinematics, TheHomePoseIsReachableAndPlausible) {  // solved by Newton's method from a bent arm
  JointAngles q{0.0, 0.4, 0.6};
  for (int i = 0; i < 50; ++i) {
    const Vec3 step = arm().jacobian(q).colPivHouseholderQr().solve(arm().home_m() - arm().position(q));
    for (std::size_t j = 0; j < 3; ++j) q[j] += step[static_cast<Eigen::Index>(j)];
  }
  EXPECT_LT((arm().position(q) - arm().home_m()).norm(), 1e-12);
  EXPECT_TRUE(arm().is_plausible(q));
  EXPECT_FALSE(arm().is_plausible({2.0, 0.4, 0.6}));
  EXPECT_FALSE(arm().is_plausible({std::nan(""), 0.4, 0.6}));
}

// The stop between the links limits the forearm's angle less the shoulder's, to -0.81 .. 1.25 rad.
TEST(Kinematics, TheForearmsStopIsBetweenTheLinks) {
  EXPECT_FALSE(arm().is_plausible({0.0, 0.87, -0.68}));  // -1.55 between the links
  EXPECT_TRUE(arm().is_plausible({0.0, 1.7, 2.9}));      // 1.2 between them, although the forearm itself is at 2.9
  EXPECT_EQ(arm().far_from_stops({0.0, 1.2, 1.3}), (std::array{true, true, true}));
  EXPECT_EQ(arm().far_from_stops({0.0, 1.6, 0.8}), (std::array{true, false, false}));
}

TEST(Kinematics, LeversAtHomeAreThoseOfTheDrawing) {  // the waist's: from its axis to the tip, seen from above
  const auto d = device::omni();
  ASSERT_EQ(d.home_tip_m[0], 0.0);
  EXPECT_LT((levers_at_home_m(d) - Vec3(-d.home_tip_m[1], kUpperArm_m, kForearm_m)).norm(), 1e-12);
}

// A Cartesian device, three drums: linear motion, force = torque / radius.
TEST(Kinematics, AnotherDeviceIsAFileAndAFunction) {
  device::Device d = device::omni();
  d.kinematics = device::Kinematics::kCartesian;
  d.links_m = {0.02, 0.03, 0.04};
  d.home_tip_m = {0.1, 0.2, 0.3};
  d.joint_min_rad = {-7, -7, -7};
  d.joint_max_rad = {7, 7, 7};
  const Linkage axes(d);
  EXPECT_LT((axes.position({1.0, -2.0, 3.0}) - Vec3(0.12, 0.14, 0.42)).norm(), 1e-15);
  EXPECT_LT((axes.torque({1.0, -2.0, 3.0}, Vec3(1, 2, 3)) - Vec3(0.02, 0.06, 0.12)).norm(), 1e-15);
  EXPECT_TRUE(axes.is_plausible({6.0, -6.0, 7.0}));
  EXPECT_FALSE(axes.is_plausible({8.0, 0.0, 0.0}));
}

}  // namespace
}  // namespace ligature::control
