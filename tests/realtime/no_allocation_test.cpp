// The two real-time contexts neither allocate, lock nor throw: the whole cycle (bus code, control, records) and the
// thread's physics, with and without a clock that ends its ticks. Hooks on the allocator and on mutexes and Eigen's
// run-time malloc check watch them; both are first shown to detect a violation.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cstdlib>
#include <mutex>

#include "tests/realtime/quiet_rig.hpp"
#include "tests/realtime/watch.hpp"

namespace ligature {
namespace {

/// While it lives: counts allocator calls and locks, and makes Eigen assert on allocation.
class NoAllocation {
 public:
  NoAllocation() {
    watch::allocations = watch::locks = 0;
    Eigen::internal::set_is_malloc_allowed(false);
    watch::watching = true;
  }
  ~NoAllocation() {
    watch::watching = false;
    Eigen::internal::set_is_malloc_allowed(true);
  }
};

void expect_quiet(const scene::Scene& scene, Nanoseconds per_question = {}) {
  VirtualRig rig(scene);
  for (auto& hand : rig.bus.reading.hand) hand.grip = true;
  QuietRun run(rig);
  auto& cycle = run.cycle;
  run.physics.per_question = per_question;
  cycle.end_after(2000);
  rig.outlets->commands.push({1, rt::CommandKind::kResetThread});
  {
    const NoAllocation guard;
    cycle.run();
  }
  EXPECT_EQ(watch::allocations, 0);
  EXPECT_EQ(watch::locks, 0);
  EXPECT_GE(cycle.periods(), 2000);
  EXPECT_EQ(cycle.timing().thread_cut > 1000, per_question > Nanoseconds::zero()) << "does the clock end its ticks?";
  EXPECT_EQ(rig.controller.fault(), control::Fault::kNone);
}

TEST(NoAllocation, TheGuardsBite) {
  if (watch::kCounts) {
    std::mutex mutex;
    {
      const NoAllocation guard;
      void* volatile here = malloc(8);  // volatile: else the compiler removes the unused allocation
      free(here);
      const std::lock_guard nobody_else_wants_it(mutex);
    }
    EXPECT_GT(watch::allocations, 0);
    EXPECT_GT(watch::locks, 0);
    {
      const NoAllocation guard;
      try {
        throw 1;  // NOLINT(bugprone-std-exception-baseclass): any exception will do
      } catch (int) {
      }
    }
    EXPECT_GT(watch::allocations, 0) << "an exception is one, too, even when it is caught";
  }
  EXPECT_DEATH(
      {
        const NoAllocation guard;
        const Eigen::MatrixXd m(100, 100);
      },
      "heap allocation is forbidden");
}

TEST(NoAllocation, TheWholeCycleWithASmallThread) { expect_quiet(small_scene()); }

TEST(NoAllocation, TheWholeCycleWithAThreadWhoseTicksTheClockEnds) {
  scene::Scene s = small_scene();
  s.time.substeps = 8;
  expect_quiet(s, std::chrono::microseconds(200));
  s.suture.model = scene::Model::kRod;
  s.suture.radius_m = 1e-3;
  expect_quiet(s, std::chrono::microseconds(50));  // virtual time of each piece of work; the clock then ends ticks
}

TEST(NoAllocation, TakingAnotherSceneOrOtherParameters) {
  for (const bool keeps_motion : {false, true}) {
    for (const auto model : {scene::Model::kPaper4, scene::Model::kRod}) {
      scene::Scene s = small_scene();
      s.suture.model = model;
      if (model == scene::Model::kRod) s.suture.radius_m = 1e-3;
      VirtualRig rig(s, {20, false});
      scene::Scene other = s;
      other.contact.friction = 0.7;
      control::Plant plant{std::get<physics::Simulation>(physics::Simulation::make(other)), other.hands, keeps_motion,
                           false};
      control::PlantHandover plants;
      QuietRun run(rig);
      auto& cycle = run.cycle;
      cycle.listen(plants);
      cycle.end_after(100);
      plants.offer(&plant);
      {
        const NoAllocation guard;
        cycle.run();
      }
      EXPECT_EQ(watch::allocations, 0);
      EXPECT_EQ(watch::locks, 0);
      EXPECT_TRUE(plant.taken);
    }
  }
}

TEST(NoAllocation, TheWholeCycleWithEveryModelAndSolver) {
  for (const auto model : {scene::Model::kPaper1, scene::Model::kPaper2, scene::Model::kPaper3, scene::Model::kPaper4,
                           scene::Model::kPaper5}) {
    for (const auto solver :
         {scene::ContactSolver::kNone, scene::ContactSolver::kPaper, scene::ContactSolver::kImplicit}) {
      scene::Scene s = small_scene();
      s.suture.model = model;
      s.contact.solver = solver;
      // make() rejects this combination of model and solver.
      if (!std::holds_alternative<physics::Simulation>(physics::Simulation::make(s))) continue;
      expect_quiet(s);
    }
  }
}

}  // namespace
}  // namespace ligature
