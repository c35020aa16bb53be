// No allocation in the loop: the whole cycle (bus code, control, physics, records) runs under two guards, a hook on the
// process' allocator and Eigen's run-time switch. Both guards are first shown to bite.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <atomic>
#include <cstdlib>

#include "tests/realtime/quiet_rig.hpp"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define LIGATURE_HOOKS 0  // the sanitizer owns malloc; Eigen's switch still watches
#else
#define LIGATURE_HOOKS 1
#endif

namespace {
thread_local bool watching = false;
thread_local long allocations = 0;
}  // namespace

#if LIGATURE_HOOKS
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);

// Every way to the heap ends in one of these, operator new included.
void* malloc(std::size_t n) {
  allocations += watching;
  return __libc_malloc(n);
}
void* calloc(std::size_t n, std::size_t size) {
  allocations += watching;
  return __libc_calloc(n, size);
}
void* realloc(void* p, std::size_t n) {
  allocations += watching;
  return __libc_realloc(p, n);
}
void* aligned_alloc(std::size_t alignment, std::size_t n) {
  allocations += watching;
  return __libc_memalign(alignment, n);
}
int posix_memalign(void** p, std::size_t alignment, std::size_t n) {
  allocations += watching;
  *p = __libc_memalign(alignment, n);
  return *p == nullptr ? 12 : 0;
}
void free(void* p) {
  allocations += watching && p != nullptr;  // giving back is a call into the allocator, too
  __libc_free(p);
}
}
#endif

namespace ligature {
namespace {

/// Counts calls into the allocator, and makes Eigen assert, while it lives.
class NoAllocation {
 public:
  NoAllocation() {
    allocations = 0;
    Eigen::internal::set_is_malloc_allowed(false);
    watching = true;
  }
  ~NoAllocation() {
    watching = false;
    Eigen::internal::set_is_malloc_allowed(true);
  }
};

void expect_quiet(const scene::Scene& scene) {
  VirtualRig rig(scene);
  for (auto& hand : rig.bus.reading.hand) hand.grip = true;
  QuietBus bus(rig.bus);
  QuietClock clock;
  Cycle cycle(bus, clock, rig.controller, rig.thread, *rig.outlets);
  cycle.end_after(2000);
  rig.outlets->commands.push({1, rt::CommandKind::kResetThread});
  {
    const NoAllocation guard;
    cycle.run();
  }
  EXPECT_EQ(allocations, 0);
  EXPECT_GE(cycle.periods(), 2000);
  EXPECT_EQ(rig.controller.fault(), control::Fault::kNone);
}

TEST(NoAllocation, TheGuardsBite) {
#if LIGATURE_HOOKS
  {
    const NoAllocation guard;
    free(malloc(8));
  }
  EXPECT_GT(allocations, 0);
#endif
  EXPECT_DEATH(
      {
        const NoAllocation guard;
        const Eigen::MatrixXd m(100, 100);
      },
      "heap allocation is forbidden");
}

TEST(NoAllocation, TheWholeCycleWithASmallThread) { expect_quiet(small_scene()); }

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
      QuietBus bus(rig.bus);
      QuietClock clock;
      Cycle cycle(bus, clock, rig.controller, rig.thread, *rig.outlets);
      cycle.listen(plants);
      cycle.end_after(100);
      plants.offer(&plant);
      {
        const NoAllocation guard;
        cycle.run();
      }
      EXPECT_EQ(allocations, 0);
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
      if (!std::holds_alternative<physics::Simulation>(physics::Simulation::make(s))) continue;  // refused at start
      expect_quiet(s);
    }
  }
}

}  // namespace
}  // namespace ligature
