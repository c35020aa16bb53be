#include "sim_device/kinematics.hpp"

#include <gtest/gtest.h>

#include <random>

#include "sim_device/plant.hpp"

namespace ligature::sim {
namespace {

Vec3 random_joints(std::mt19937& random) {
  std::uniform_real_distribution<double> waist(-0.9, 0.9), shoulder(0.0, 1.7), elbow(-0.75, 1.2);
  const double q2 = shoulder(random);
  return {waist(random), q2, q2 + elbow(random)};
}

TEST(Kinematics, HomeIsWhereItIsSaidToBe) {
  const auto q = joints_of_tip(home_tip_D_m());
  ASSERT_TRUE(q);
  EXPECT_TRUE(Plant::is_within_stops(*q));
  EXPECT_NEAR((tip_D_m(*q) - Vec3(0.0, -0.17, 0.0)).norm(), 0.0, 1e-12);
}

TEST(Kinematics, AnglesOfATipLeadBackToIt) {  // over the whole reach inside the stops
  std::mt19937 random(11);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 q = random_joints(random);
    const Vec3 p_DT = tip_D_m(q);
    if (std::hypot(p_DT.x(), p_DT.y()) < 1e-3) continue;  // above the waist axis q1 is free
    const auto back = joints_of_tip(p_DT);
    ASSERT_TRUE(back);
    EXPECT_NEAR((tip_D_m(*back) - p_DT).norm(), 0.0, 1e-12);
  }
}

TEST(Kinematics, LinksHaveTheirLengths) {  // a closed form that knows nothing of the angles' meaning
  EXPECT_NEAR(tip_D_m({0.0, 0.0, std::acos(-1.0) / 2}).norm(), kUpperArm_m + kForearm_m, 1e-12);  // stretched forwards
  EXPECT_NEAR((tip_D_m({0.0, 0.0, 0.0}) - Vec3(0.0, -kUpperArm_m, -kForearm_m)).norm(), 0.0, 1e-12);
}

TEST(Kinematics, JacobianIsTheDerivativeOfTheTip) {  // central difference, error of order h^2
  std::mt19937 random(12);
  constexpr double h = 1e-6;
  for (int i = 0; i < 200; ++i) {
    const Vec3 q = random_joints(random);
    for (int j = 0; j < 3; ++j) {
      const Vec3 dq = h * Vec3::Unit(j);
      EXPECT_NEAR(((tip_D_m(q + dq) - tip_D_m(q - dq)) / (2 * h) - tip_jacobian_D(q).col(j)).norm(), 0.0, 1e-9);
    }
  }
}

TEST(Kinematics, OutOfReachIsRefused) {
  EXPECT_FALSE(joints_of_tip({0.0, -0.27, 0.0}));
  EXPECT_FALSE(joints_of_tip({0.0, 0.0, 0.0}));
}

}  // namespace
}  // namespace ligature::sim
