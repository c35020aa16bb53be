// MoveCheck compares commanded with measured joint motion, in encoder counts, after a move led by the controller.
#include "firmware/control/move_check.hpp"

#include <gtest/gtest.h>

namespace ligature::control {
namespace {

constexpr double kCount_rad = 1e-3;

/// Judges a move of 100 ticks from some pose: commanded motion of each joint and the motion its encoder showed, in
/// counts.
JointFault judged(const Vec3& asked_counts, const Vec3& went_counts) {
  const Vec3 from(0.3, -0.2, 0.7);
  MoveCheck check;
  check.start({from[0], from[1], from[2]});
  const Mat3 inverse_jacobian = 2.0 * Mat3::Identity();  // rad/m, the same for all joints
  for (int i = 0; i < 100; ++i) check.step(inverse_jacobian, 0.5 * kCount_rad * asked_counts / 0.1, 1e-3);
  const Vec3 at = from + kCount_rad * went_counts;
  return check.judge({at[0], at[1], at[2]}, kCount_rad);
}

TEST(MoveCheck, AJointThatWentTwentyFiveCountsAgainstItsWayIsReversed) {
  EXPECT_EQ(judged({40, 40, 40}, {40, -24, 40}), JointFault{}) << "a hand that trembles, or gives way";
  EXPECT_EQ(judged({40, 40, 40}, {40, -26, 40}), fault_of_joint(Fault::kAxisReversed, 1));
  EXPECT_EQ(judged({-40, 40, 40}, {26, 40, 40}), fault_of_joint(Fault::kAxisReversed, 0));
  EXPECT_EQ(judged({40, 5, 40}, {40, -26, 40}), fault_of_joint(Fault::kAxisReversed, 1))
      << "however little was asked of it";
}

TEST(MoveCheck, AJointThatStoodWhileAnotherFollowedIsFrozen) {
  EXPECT_EQ(judged({40, 40, 40}, {40, 0, 40}), fault_of_joint(Fault::kEncoderFrozen, 1));
  EXPECT_EQ(judged({40, 40, 40}, {40, 2, 40}), fault_of_joint(Fault::kEncoderFrozen, 1)) << "an encoder's noise";
  EXPECT_EQ(judged({40, 40, 40}, {40, 3, 40}), JointFault{}) << "stiff, but alive";
  EXPECT_EQ(judged({40, 24, 40}, {40, 0, 40}), JointFault{}) << "it had no way to go";
  EXPECT_EQ(judged({40, 40, 40}, {0, 40, 40}), fault_of_joint(Fault::kEncoderFrozen, 0));
  EXPECT_EQ(judged({40, 40, 40}, {40, 40, 0}), fault_of_joint(Fault::kEncoderFrozen, 2));
  EXPECT_EQ(judged({40, 26, 40}, {40, 0, 40}), fault_of_joint(Fault::kEncoderFrozen, 1));
}

TEST(MoveCheck, AHandThatHoldsOnIsNoFault) {
  EXPECT_EQ(judged({40, 40, 40}, {0, 0, 0}), JointFault{});
  EXPECT_EQ(judged({40, 40, 40}, {19, 0, 1}), JointFault{}) << "nobody came half its way";
  EXPECT_EQ(judged({40, 40, 40}, {21, 0, 1}), fault_of_joint(Fault::kEncoderFrozen, 1));
  EXPECT_EQ(judged({40, 40, 10}, {1, 1, 10}), JointFault{}) << "a way of ten counts tells nothing";
}

TEST(MoveCheck, EachMoveIsJudgedByItself) {  // forth, and half the way back
  MoveCheck check;
  check.start({0.0, 0.0, 0.0});
  for (int i = 0; i < 100; ++i) check.step(Mat3::Identity(), Vec3(0.8, 0, 0), 1e-3);
  EXPECT_EQ(check.judge({0.08, 0.0, 0.0}, kCount_rad), JointFault{});
  check.start({0.08, 0.0, 0.0});
  for (int i = 0; i < 100; ++i) check.step(Mat3::Identity(), Vec3(-0.4, 0, 0), 1e-3);
  EXPECT_EQ(check.judge({0.04, 0.0, 0.0}, kCount_rad), JointFault{});
}

}  // namespace
}  // namespace ligature::control
