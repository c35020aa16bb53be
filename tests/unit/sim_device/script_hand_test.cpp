#include "sim_device/script_hand.hpp"

#include <gtest/gtest.h>

#include "protocol/scene/monotone_cubic.hpp"
#include "tests/unit/sim_device/omni.hpp"

namespace ligature::sim {
namespace {

scene::GripperScript script(double far_m = 0.2) {
  scene::GripperScript s;
  s.motion = scene::Motion::kMonotoneCubic;
  s.keys[1] = {{0.5, {0.5, -0.4, 3.2}, true},
               {1.0, {0.7, -0.4, 3.1}, true},
               {2.5, {0.9 + far_m, -0.2, 3.0}, false},
               {4.0, {0.9 + far_m, 0.1, 3.0}, false}};
  scene::pass_through(s.keys[1]);
  return s;
}

std::unique_ptr<Intention> made(const scene::GripperScript& s, std::size_t hand) {
  auto hands = script_hand(s, hand, paper_map());
  return std::get<std::unique_ptr<Intention>>(std::move(hands));
}

/// With the same script, a simulated device's hand follows the same path as the tools in `ligature-lab`.
TEST(ScriptHand, PassesWhereTheLabPasses) {
  const auto s = script();
  const auto hand = made(s, 1);
  for (double t_s = -1.0; t_s < 5.0; t_s += 0.037) {
    const auto intent = hand->at(t_s, {});
    const auto lab = scene::sample(s.keys[1], t_s);
    EXPECT_LT((paper_map().to_world(intent.p_DH) - Vec3(lab.p_W_m.data())).norm(), 1e-12) << t_s;
    EXPECT_LT((kPaperScale * intent.v_DH - Vec3(lab.v_W_m_per_s.data())).norm(), 1e-12) << t_s;
    EXPECT_EQ(intent.grip, lab.grip) << t_s;
  }
  EXPECT_GT(hand->at(1.0, {}).v_DH.norm(), 0.0);  // in motion
  EXPECT_EQ(hand->end_s(), 4.0);
  EXPECT_EQ(hand->start_D_m(), hand->at(0.0, {}).p_DH);
}

TEST(ScriptHand, RestsInEveryKeyUnlessTheScriptSaysOtherwise) {
  auto s = script();
  s.motion = scene::Motion::kRests;
  EXPECT_NEAR(made(s, 1)->at(1.0, {}).v_DH.norm(), 0.0, 1e-9);
}

TEST(ScriptHand, RefusesAKeyOutOfReachByItsTimeInEitherMotion) {
  for (const auto motion : {scene::Motion::kRests, scene::Motion::kMonotoneCubic}) {
    auto s = script(9.0);
    s.motion = motion;
    const auto refused = script_hand(s, 1, paper_map());
    ASSERT_TRUE(std::holds_alternative<std::string>(refused));
    EXPECT_NE(std::get<std::string>(refused).find("key at time 2.5 s"), std::string::npos);
  }
}

TEST(ScriptHand, AnAbsentHandRestsAtHome) {
  EXPECT_EQ(made(script(), 0)->at(3.0, {}).p_DH, paper_map().linkage.home_D_m());
}

}  // namespace
}  // namespace ligature::sim
