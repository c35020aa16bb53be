// A plant (a new simulation of the thread, or new parameters) is passed to the running loop between two ticks.
#include <gtest/gtest.h>

#include "tests/unit/firmware/virtual_rig.hpp"

namespace ligature {
namespace {

struct PlantRig : VirtualRig {
  explicit PlantRig(bool armed) : VirtualRig(small_scene(), {20, armed}) {
    cycle.listen(plants);
    for (auto& hand : bus.reading.hand) hand.grip = true;
  }
  void offer(const scene::Scene& scene, bool keeps_motion) {
    plant = std::make_unique<control::Plant>(control::Plant{
        std::get<physics::Simulation>(physics::Simulation::make(scene)), scene.hands, keeps_motion, false});
    plants.offer(plant.get());
  }
  void run(std::int64_t ticks) {
    cycle.end_after(ticks);
    cycle.run();
  }
  control::PlantHandover plants;
  std::unique_ptr<control::Plant> plant;
};

scene::Scene other_scene() {
  scene::Scene other = small_scene();
  other.suture.nodes = 30;
  return other;
}

double size(const rt::Triple& f) { return std::sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]); }

TEST(Plant, ASceneIsTakenWhileNoForceMayFlow) {
  PlantRig rig(false);
  rig.offer(other_scene(), false);
  rig.run(300);
  ASSERT_EQ(rig.plants.collect(), rig.plant.get());
  EXPECT_TRUE(rig.plant->taken);
  EXPECT_EQ(rig.thread.nodes_W().size(), 30U);
  EXPECT_EQ(rig.plant->thread.nodes_W().size(), 10U) << "the old one comes back to be destroyed elsewhere";
}

TEST(Plant, TheHandsTakeTheNewScenesWorkspace) {
  PlantRig rig(false);
  scene::Scene moved = small_scene();
  moved.hands.workspace_origin_m[0] += 1.0;
  rig.offer(moved, false);
  rig.run(300);
  ASSERT_EQ(rig.plants.collect(), rig.plant.get());
  const auto records = rig.records();
  EXPECT_NEAR(records.back().p_WT_m[0][0] - records.front().p_WT_m[0][0], 1.0, 1e-9);
}

TEST(Plant, ASceneIsRefusedByTheLoopWhileArmed) {
  PlantRig rig(true);
  rig.offer(other_scene(), false);
  rig.run(300);
  ASSERT_EQ(rig.plants.collect(), rig.plant.get());
  EXPECT_FALSE(rig.plant->taken);
  EXPECT_EQ(rig.thread.nodes_W().size(), 10U);
}

TEST(Plant, ASceneIsRefusedWhileForceStillEnds) {  // disarmed, but the force has not yet faded
  PlantRig rig(true);
  rig.bus.on_sync = [&](std::int64_t sync) {
    if (sync == 1500) rig.outlets->commands.push({1, rt::CommandKind::kDisarm});
    if (sync == 1520) rig.offer(other_scene(), false);
  };
  rig.run(2000);
  const auto records = rig.records();
  ASSERT_GT(size(records[1519].f_device_N[0]), 0.0);
  ASSERT_EQ(rig.plants.collect(), rig.plant.get());
  EXPECT_FALSE(rig.plant->taken);
}

TEST(Plant, AParameterChangesUnderForceWithoutAJumpOfItAndWithoutLettingGo) {
  PlantRig rig(true);
  rig.bus.on_sync = [&](std::int64_t sync) {
    if (sync != 1500) return;
    scene::Scene other = small_scene();
    other.suture.paper.bend *= 2.0;
    other.hands.force_scale *= 3.0;
    rig.offer(other, true);
  };
  rig.run(2000);
  ASSERT_TRUE(rig.plant && rig.plant->taken);
  const auto after = rig.records();
  ASSERT_EQ(after[1900].grasped_node, after[1400].grasped_node) << "both hands still hold";
  ASSERT_GE(after[1400].grasped_node[0], 0);
  const double held_N = size(after[1490].f_device_N[0]);
  ASSERT_GT(held_N, 0.0);
  for (std::size_t i = 1495; i < 1800; ++i) {
    const double jump_N = std::abs(size(after[i].f_device_N[0]) - size(after[i - 1].f_device_N[0]));
    ASSERT_LE(jump_N, 0.05 * held_N) << i;
  }
  EXPECT_GT(size(after[1900].f_device_N[0]), 1.5 * held_N) << "and the new force scale is in force";
}

}  // namespace
}  // namespace ligature
