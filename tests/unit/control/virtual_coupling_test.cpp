// The felt force: its signs, its scale, its limit.
#include "firmware/control/virtual_coupling.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include <limits>

#include "firmware/control/workspace_map.hpp"

namespace ligature::control {
namespace {

using physics::Vec3;

scene::Hands hands() {
  scene::Hands h;
  h.coupling_N_per_m = 1200.0;
  h.coupling_N_s_per_m = 6.0;
  h.force_scale = 0.003;
  h.max_force_N = 3.3;
  return h;
}

TEST(Saturate, NeverAboveTheLimitHoweverItIsMeasured) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0.0, 20.0);
  for (int i = 0; i < 100'000; ++i) {
    const Vec3 wanted(normal(random), normal(random), normal(random));
    const auto f = saturate(wanted, 3.3).f_N;
    ASSERT_LE(f.norm(), 3.3);
    ASSERT_LE(std::hypot(f.x(), f.y(), f.z()), 3.3);
    ASSERT_LE(std::sqrt(f.x() * f.x() + f.y() * f.y() + f.z() * f.z()), 3.3);
  }
}

TEST(VirtualCoupling, AnEmptyHandFeelsNothing) {
  EXPECT_EQ(VirtualCoupling(hands()).force({false, Vec3(1, 1, 1), Vec3::Zero()}, Vec3::Zero(), Vec3::Zero()).f_N,
            Vec3::Zero());
}

TEST(VirtualCoupling, PullsTowardsTheNode) {  // node 0.1 m above: 1200 x 0.1 x 0.003 = 0.36 N upwards
  const auto f = VirtualCoupling(hands()).force({true, Vec3(0, 0, 0.1), Vec3::Zero()}, Vec3::Zero(), Vec3::Zero());
  EXPECT_NEAR(f.f_N.z(), 0.36, 1e-12);
  EXPECT_FALSE(f.limited);
}

TEST(VirtualCoupling, ResistsTheHandsOwnMotion) {  // damping takes energy: force against velocity
  const auto f = VirtualCoupling(hands()).force({true, Vec3::Zero(), Vec3::Zero()}, Vec3::Zero(), Vec3(2, 0, 0));
  EXPECT_NEAR(f.f_N.x(), -6.0 * 2 * 0.003, 1e-12);
}

TEST(VirtualCoupling, LimitsTheMagnitudeAndKeepsTheDirection) {
  const auto f = VirtualCoupling(hands()).force({true, Vec3(30, 40, 0), Vec3::Zero()}, Vec3::Zero(), Vec3::Zero());
  EXPECT_TRUE(f.limited);
  EXPECT_NEAR(f.f_N.norm(), 3.3, 1e-12);
  EXPECT_NEAR(f.f_N.x() / f.f_N.y(), 0.75, 1e-12);
}

TEST(Saturate, LimitsEvenTheLargestNumbers) {
  const auto f = saturate(Vec3(1e308, 1e308, 0), 3.3);
  EXPECT_TRUE(f.limited && f.finite);
  EXPECT_NEAR(f.f_N.norm(), 3.3, 1e-12);
}

TEST(Saturate, TurnsWhatIsNoNumberIntoZeroAndTells) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    const auto f = saturate(Vec3(bad, 0, 0), 3.3);
    EXPECT_FALSE(f.finite);
    EXPECT_EQ(f.f_N, Vec3::Zero());
  }
}

TEST(WorkspaceMap, HomeIsTheOriginAndLengthsScale) {
  scene::Hands h = hands();
  h.workspace_scale = 20.0;
  h.workspace_origin_m = {0.5, -0.4, 3.2};
  const WorkspaceMap map(h);
  EXPECT_LT((map.position(kHome_DT_m) - Vec3(0.5, -0.4, 3.2)).norm(), 1e-12);
  EXPECT_LT((map.position(kHome_DT_m + Vec3(0.01, 0, 0)) - Vec3(0.7, -0.4, 3.2)).norm(), 1e-12);
  EXPECT_LT((map.velocity(Vec3(0, 0.1, 0)) - Vec3(0, 2, 0)).norm(), 1e-12);
}

}  // namespace
}  // namespace ligature::control
