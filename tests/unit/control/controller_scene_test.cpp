// What a new scene changes in the control law: coupling, lengths, force scale, and limits.
#include <gtest/gtest.h>

#include "firmware/control/workspace_map.hpp"
#include "tests/unit/control/controller_rig.hpp"

namespace ligature::control {
namespace {

TEST(Controller, ASceneTakenOnTheWayBringsItsForceLimitAndItsPassivity) {
  Rig rig(Rig::scene(), Rig::drums());
  rig.ticks(60);
  ASSERT_EQ(rig.controller.state(), State::kEngage);
  auto hands = Rig::scene();
  hands.max_force_N = 1.0;
  rig.controller.change_hands(hands);
  rig.to_force();
  rig.offset_m = 50.0;
  rig.ticks(40);
  EXPECT_NEAR(rig.controller.hand(0).f_device_N.norm(), 1.0, 1e-9);

  for (const bool on : {false, true}) {  // hands that never moved have no energy credit
    hands = Rig::scene();
    hands.energy_credit_J = 0.0;
    hands.passivity = !on;
    Rig other(hands, Rig::drums());
    other.ticks(60);
    hands.passivity = on;
    other.controller.change_hands(hands);
    other.ticks(1000);
    other.offset_m = 50.0;
    other.ticks(40);
    EXPECT_EQ(other.controller.hand(0).f_device_N.norm() < 3.0, on);
  }
}

TEST(Controller, ASceneBringsItsCouplingAndItsLengths) {  // 2400 N/m x 0.05 m x 0.003 = 0.36 N
  Rig rig;
  rig.ticks(60);
  auto hands = Rig::scene();
  hands.coupling_N_per_m = 2400.0;
  hands.workspace_scale = 10.0;
  rig.controller.change_hands(hands);
  rig.tick();
  const Linkage linkage(device::omni());
  const Vec3 tool_m = WorkspaceMap(hands, linkage.home_m()).position(linkage.position({0.0, 0.5, 0.6}));
  EXPECT_LT((rig.controller.tools()[0].p_WT - tool_m).norm(), 1e-12);
  rig.tick();
  EXPECT_NEAR(rig.controller.hand(0).f_wish_N.norm(), 0.36, 1e-9);
}

// Else the new scene would get the scale that was asked of the old one.
TEST(Controller, ASceneEndsAChangeOfTheForceScale) {
  Rig rig;
  rig.ticks(60);
  rig.controller.change_force_scale(0.006);
  rig.ticks(210);
  EXPECT_NEAR(rig.controller.hand(0).f_wish_N.norm(), 0.36, 1e-9);
  rig.controller.change_hands(Rig::scene());
  rig.ticks(300);
  EXPECT_NEAR(rig.controller.hand(0).f_wish_N.norm(), 0.18, 1e-9);
}

TEST(Controller, ASceneMayNotExceedTheDevicesPeak) {
  auto hands = Rig::scene();
  hands.max_force_N = 50.0;
  Rig rig(hands);
  rig.to_force();
  rig.pull_hard();
  EXPECT_LE(AnyPose(device::omni()).most_N(vector_of(rig.tick().hand[0].torque_Nm)), 3.31);
}

}  // namespace
}  // namespace ligature::control
