#include <gtest/gtest.h>

#include "host/lab/unknotting/planner.hpp"
#include "ligature_source_dir.hpp"

namespace ligature::lab {
namespace {

using physics::Vec3;

const std::string kDesk = LIGATURE_SOURCE_DIR "/scenes/desk.toml";

std::vector<Vec3> shape_of(const physics::Simulation& thread) {
  const auto nodes = thread.nodes_W();
  return {nodes.begin(), nodes.end()};
}

TEST(Core, OfAStraightThreadIsEmpty) {
  std::vector<Vec3> straight;
  for (int k = 0; k < 20; ++k) straight.emplace_back(0.0, 0.0, 0.1 * k);
  const auto core = core_of(straight);
  EXPECT_GT(core.first, core.last);
}

TEST(Core, HoldsTheKnotAndNothingThatCanBeCutOff) {
  Rehearsal r(load_scene_or_refuse(kDesk, {}), {});
  r.run_until(1.0);
  const auto shape = shape_of(r.simulation());
  const auto core = core_of(shape);
  const auto type = [&](int first, int last) {
    std::vector<std::array<double, 3>> line;
    for (int k = first; k <= last; ++k) {
      const auto& p = shape[static_cast<std::size_t>(k)];
      line.push_back({p.x(), p.y(), p.z()});
    }
    return knot::recognise(line, false).type;
  };
  EXPECT_EQ(type(core.first, core.last), "4_1");
  EXPECT_NE(type(core.first + 1, core.last), "4_1");
  EXPECT_NE(type(core.first, core.last - 1), "4_1");
}

TEST(Planner, UndoesTheFigureEightOnTheDeskAndAWrongNodeDoesNot) {
  const auto scene = load_scene_or_refuse(kDesk, {});
  Rehearsal r(scene, {});
  r.run_until(5.0);
  const auto shape = shape_of(r.simulation());
  ASSERT_EQ(knot_of(r.simulation()).type, "4_1");
  const auto plan = plan_pull(shape, scene);
  ASSERT_TRUE(plan);
  EXPECT_EQ(do_pull(r.simulation(), scene, plan->pull).knot.type, "0_1");
  EXPECT_EQ(try_pull(shape, scene, {49, Vec3(1.0, 0.0, 0.0)}).knot.type, "4_1");
}

TEST(Planner, HasNoPlanForAnUnknot) {
  const auto scene = load_scene_or_refuse(LIGATURE_SOURCE_DIR "/scenes/paper.toml", {"suture.nodes=20"});
  const Rehearsal r(scene, {});
  EXPECT_FALSE(plan_pull(shape_of(r.simulation()), scene));
}

}  // namespace
}  // namespace ligature::lab
