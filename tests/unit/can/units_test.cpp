#include "protocol/can/units.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/random.hpp"

namespace ligature::can {
namespace {

TEST(Units, AnglesComeBackWithinHalfACount) {
  test::Random random(5);
  const auto angle = [&] { return random.in(-3.2, 3.2); };
  for (int i = 0; i < 10000; ++i) {
    const double q = angle();
    EXPECT_NEAR(angle_rad(counts_of(q)), q, 0.5 * kRadPerCount * (1 + 1e-9));
  }
}

TEST(Units, TorqueComesBackWithinHalfAPermille) {
  for (double torque = -0.9; torque <= 0.9; torque += 1e-4) {
    EXPECT_NEAR(torque_Nm(permille_of(torque)), torque, 0.5 * kNmPerPermille * (1 + 1e-9));
  }
}

TEST(Units, TorqueIsClippedAndNeverNotANumber) {
  EXPECT_EQ(permille_of(std::numeric_limits<double>::quiet_NaN()), 0);
  EXPECT_EQ(permille_of(std::numeric_limits<double>::infinity()), 3000);
  EXPECT_EQ(permille_of(-std::numeric_limits<double>::infinity()), -3000);
}

TEST(Units, TorqueReachesTheForceLimitAtFullReach) {  // largest force 3.3 N, stretched arm of 0.134 + 0.1325 m
  EXPECT_LT(3.3 * (0.134 + 0.1325), torque_Nm(profile::kMaxTorque_permille));
}

}  // namespace
}  // namespace ligature::can
