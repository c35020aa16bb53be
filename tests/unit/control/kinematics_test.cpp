// The linkage against geometry, finite differences and virtual work.
#include "firmware/control/kinematics.hpp"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace ligature::control {
namespace {

std::vector<JointAngles> poses() {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> q1(-0.9, 0.9), q2(0.0, 1.7), bend(-0.8, 1.2);
  std::vector<JointAngles> all;
  for (int i = 0; i < 200; ++i) {
    const double shoulder = q2(random);
    all.push_back({q1(random), shoulder, shoulder + bend(random)});
  }
  return all;
}

TEST(Kinematics, UpperArmLevelAndForearmHangingIsReadOffTheDrawing) {
  const Vec3 p = tip_position({0.0, 0.0, 0.0});
  EXPECT_NEAR(p.x(), 0.0, 1e-15);
  EXPECT_NEAR(p.y(), -kUpperArm_m, 1e-15);  // towards the person
  EXPECT_NEAR(p.z(), -kForearm_m, 1e-15);
}

TEST(Kinematics, StretchedArmReachesTheSumOfTheLinks) {
  const Vec3 p = tip_position({0.0, 0.0, std::numbers::pi / 2});
  EXPECT_NEAR(p.norm(), kUpperArm_m + kForearm_m, 1e-15);
}

TEST(Kinematics, ForearmAngleIsAbsolute) {  // moving the shoulder alone translates the forearm, it does not turn it
  const JointAngles a{0.0, 0.2, 0.7}, b{0.0, 0.9, 0.7};
  const Vec3 shift = tip_position(b) - tip_position(a);
  EXPECT_NEAR(shift.y(), -kUpperArm_m * (std::cos(0.9) - std::cos(0.2)), 1e-15);
  EXPECT_NEAR(shift.z(), kUpperArm_m * (std::sin(0.9) - std::sin(0.2)), 1e-15);
}

TEST(Kinematics, TurningTheWaistLeftMovesTheTipAlongX) { EXPECT_GT(tip_position({0.1, 0.3, 0.5}).x(), 0.0); }

TEST(Kinematics, JacobianIsTheDerivative) {  // central difference, step ~ eps^(1/3), error ~ eps^(2/3)
  constexpr double h = 6e-6;
  for (const JointAngles& q : poses()) {
    const Mat3 J = tip_jacobian(q);
    for (std::size_t j = 0; j < 3; ++j) {
      JointAngles above = q, below = q;
      above[j] += h;
      below[j] -= h;
      const Vec3 difference = (tip_position(above) - tip_position(below)) / (2 * h);
      EXPECT_LT((J.col(static_cast<Eigen::Index>(j)) - difference).norm(), 1e-10);
    }
  }
}

TEST(Kinematics, JointTorqueDoesTheWorkOfTheForce) {  // tau . dq = f . dp for any small motion
  std::mt19937 random(12);
  std::normal_distribution<double> any;
  for (const JointAngles& q : poses()) {
    const Vec3 f(any(random), any(random), any(random)), dq(any(random), any(random), any(random));
    const Vec3 dp = tip_jacobian(q) * dq;
    EXPECT_NEAR(joint_torque(q, f).dot(dq), f.dot(dp), 1e-12);
  }
}

TEST(Kinematics, TheHomePoseIsReachableAndPlausible) {  // solved by Newton's method from a bent arm
  JointAngles q{0.0, 0.4, 0.6};
  for (int i = 0; i < 50; ++i) {
    const Vec3 step = tip_jacobian(q).colPivHouseholderQr().solve(kHome_DT_m - tip_position(q));
    for (std::size_t j = 0; j < 3; ++j) q[j] += step[static_cast<Eigen::Index>(j)];
  }
  EXPECT_LT((tip_position(q) - kHome_DT_m).norm(), 1e-12);
  EXPECT_TRUE(is_plausible(q));
  EXPECT_FALSE(is_plausible({2.0, 0.4, 0.6}));
  EXPECT_FALSE(is_plausible({std::nan(""), 0.4, 0.6}));
}

}  // namespace
}  // namespace ligature::control
