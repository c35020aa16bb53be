// The virtual rig run some periods at a time, by a test that steers both hands.
#include "host/lab/rig/stepped_rig.hpp"

#include <gtest/gtest.h>

#include "protocol/scene/scene_file.hpp"
#include "tests/integration/virtual_rig/scenes.hpp"

namespace ligature::lab {
namespace {

const sim::Vec3 kThread{0.0, 0.0, 2.3}, kAbove{0.6, 0.0, 4.4};

scene::FaultScript fault(const std::string& name) {
  return std::get<scene::FaultScript>(scene::load_fault_script(kScenes + "faults/" + name));
}

/// Grips the thread with the left hand, arms, presses the dead-man, and lifts. `piece`: periods of each advance().
void lift(SteppedRig& rig, std::int64_t piece) {
  const auto pass = [&](std::int64_t periods) {
    for (std::int64_t done = 0; done < periods; done += piece) rig.advance(piece);
  };
  pass(500);
  rig.wish(0, {kThread, false, false});
  pass(1500);
  rig.wish(0, {kThread, false, true});
  pass(200);
  rig.command(rt::CommandKind::kArm);
  rig.wish(0, {kThread, true, true});
  pass(1000);
  rig.wish(0, {kAbove, true, true});
  pass(1500);
}

TEST(SteppedRig, AHandThatIsSteeredLiftsTheThreadAndFeelsIt) {
  SteppedRig rig(paper(), {});
  lift(rig, 100);
  const auto& last = rig.records().back();
  EXPECT_EQ(last.fault, 0);
  EXPECT_GE(last.grasped_node[0], 0);
  EXPECT_EQ(last.grasped_node[1], -1);
  EXPECT_NEAR(last.p_WT_m[0][2], kAbove.z(), 0.05);
  EXPECT_EQ(last.gain[0], 1.0);
  EXPECT_GT(rig.truth(0).back().f_N.norm(), 0.01);
  EXPECT_TRUE(rig.truth(1).back().f_N.isZero(0.0)) << "nobody presses the right dead-man";
}

TEST(SteppedRig, ThePiecesDoNotMatter) {
  SteppedRig whole(paper(), {}), pieces(paper(), {});
  lift(whole, 100);
  lift(pieces, 1);
  ASSERT_EQ(whole.records().size(), pieces.records().size());
  for (std::size_t i = 0; i < whole.records().size(); ++i) {
    ASSERT_EQ(whole.records()[i].torque_permille, pieces.records()[i].torque_permille) << i;
    ASSERT_EQ(whole.records()[i].p_WT_m, pieces.records()[i].p_WT_m) << i;
    ASSERT_EQ(whole.records()[i].potential_J, pieces.records()[i].potential_J) << i;
  }
}

TEST(SteppedRig, AFaultScriptFaultsItsHand) {
  const std::array faults{fault("lose-1.toml")};  // of the left hand, which goes stale
  SteppedRig rig(paper(), faults), other(paper(), {});
  rig.advance(1700);
  other.advance(1700);
  const auto stale = [](const SteppedRig& of, std::int32_t flag) {
    return std::ranges::count_if(of.records(), [&](const auto& r) { return r.tick > 1000 && (r.flags & flag) != 0; });
  };
  EXPECT_EQ(faults[0].hand, 0);
  EXPECT_GT(stale(rig, rt::kLeftStale), 0);
  EXPECT_EQ(stale(rig, rt::kRightStale) + stale(other, rt::kLeftStale), 0);
}

TEST(SteppedRig, TwoFaultsForOneHandAreRefused) {
  const std::array faults{fault("emergency.toml"), fault("emergency.toml")};
  EXPECT_THROW(SteppedRig(paper(), faults), std::runtime_error);
}

TEST(SteppedRig, EndsBeforeItsFirstPeriod) { const SteppedRig rig(paper(), {}); }

TEST(SteppedRig, PointsOutOfReachAreTold) {
  EXPECT_EQ(out_of_reach(paper(), kAbove), "");
  EXPECT_EQ(out_of_reach(paper(), {100.0, 0.0, 0.0}),
            "found (100, 0, 0) m, out of the device's reach; allowed: nearer to (0.5, -0.4, 3.2) m");
}

}  // namespace
}  // namespace ligature::lab
