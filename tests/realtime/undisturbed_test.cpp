// After start-up the loop and the thread's physics cause no page fault, no system call except for bus and clock, no
// denormal number and no exception. Each check is first shown to detect a violation. (The system call by which the loop
// wakes the physics is checked by RealLoop.*.)
#include <gtest/gtest.h>
#include <linux/seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <limits>
#include <thread>

#include "firmware/platform/realtime.hpp"
#include "firmware/platform/sanitized.hpp"
#include "tests/realtime/quiet_rig.hpp"

#ifdef LIGATURE_SANITIZED
#define LIGATURE_WATCHED 0  // a sanitizer itself causes page faults and system calls
#else
#define LIGATURE_WATCHED 1
#endif

namespace ligature {
namespace {

static_assert(noexcept(std::declval<QuietRun&>().cycle.run()));
static_assert(noexcept(std::declval<ThreadContext<QuietClock>&>().compute()));
static_assert(noexcept(std::declval<ThreadContext<QuietClock>&>().publish()));
static_assert(noexcept(std::declval<physics::Simulation&>().tick({})));
static_assert(noexcept(std::declval<control::Controller&>().tick({})));

struct Grasping : VirtualRig {
  Grasping() {
    for (auto& hand : bus.reading.hand) hand.grip = true;
  }
  QuietRun quiet{*this};
};

long page_faults() {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_minflt + usage.ru_majflt;
}

#if LIGATURE_WATCHED

TEST(Undisturbed, NoPageFaultAfterStart) {
  void* fresh = mmap(nullptr, 1 << 16, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  const long start = page_faults();
  *static_cast<volatile char*>(fresh) = 1;
  ASSERT_GT(page_faults(), start) << "the guard must see a first touch";
  munmap(fresh, 1 << 16);

  // Locks the memory, as the program does. If locking is refused, at least the warm-up run has mapped code and heap.
  (void)platform::lock_memory();
  Grasping warm, run;
  for (auto* each : {&warm, &run}) each->quiet.cycle.end_after(5000);
  warm.quiet.cycle.run();
  const long before = page_faults();
  run.quiet.cycle.run();
  EXPECT_EQ(page_faults() - before, 0);
  munlockall();
  EXPECT_EQ(run.controller.fault(), control::Fault::kNone);
}

/// Runs `work` in a child process under strict seccomp (the kernel kills it at any system call but read, write and
/// exit). @return the child's wait status.
template <class Work>
int status_of_confined(Work&& work) {
  const pid_t child = fork();
  if (child == 0) {
    if (prctl(PR_SET_SECCOMP, SECCOMP_MODE_STRICT) != 0) _exit(77);
    work();
    syscall(SYS_exit, 0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return status;
}

TEST(Undisturbed, NoSystemCallButBusAndClock) {
  const int caught = status_of_confined([] { syscall(SYS_getppid); });
  ASSERT_TRUE(WIFSIGNALED(caught) && WTERMSIG(caught) == SIGKILL) << "the guard must kill; status " << caught;
  Grasping run;
  run.quiet.cycle.end_after(2000);
  const int status = status_of_confined([&] { run.quiet.cycle.run(); });
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
}

#endif

TEST(Undisturbed, DenormalsAreZeroOnTheLoopsThread) {
  volatile double tiny = std::numeric_limits<double>::denorm_min(), half = 0.5;
  volatile double smallest = std::numeric_limits<double>::min();
  EXPECT_GT(tiny + tiny, 0.0) << "the guard must see a denormal where they are kept";
  double operand = 1.0, result = 1.0;
  std::thread([&] {
    platform::flush_denormals();
    operand = tiny + tiny;     // inputs: denormals are zero
    result = smallest * half;  // results: flushed to zero
  }).join();
  EXPECT_EQ(operand, 0.0);
  EXPECT_EQ(result, 0.0);
}

/// Counts the denormal velocities while an overdamped thread, displaced at the start, comes to rest.
int denormals_on_the_way_to_rest(bool flushed) {
  int count = 0;
  std::thread([&] {
    if (flushed) platform::flush_denormals();
    scene::Scene scene = small_scene();
    // At this drag velocities fall below 10^-308 within 210 s; with less or more drag later.
    scene.suture.paper.air_drag_per_s = 7.0;
    VirtualRig rig(scene);
    const auto hanging = rig.thread.nodes_W();
    std::vector<physics::Vec3> aside(hanging.begin(), hanging.end());
    for (std::size_t i = 1; i < aside.size(); ++i) aside[i].x() += 1e-3 * static_cast<double>(i);
    rig.thread.set_state(aside, {});
    for (int k = 0; k < 240'000; ++k) {
      rig.thread.tick({});
      for (const auto& v : rig.thread.velocities_W()) count += std::fpclassify(v.x()) == FP_SUBNORMAL;
    }
  }).join();
  return count;
}

TEST(Undisturbed, AThreadThatComesToRestHoldsNoDenormal) {
  EXPECT_GT(denormals_on_the_way_to_rest(false), 0) << "there must be some to flush";
  EXPECT_EQ(denormals_on_the_way_to_rest(true), 0);
}

}  // namespace
}  // namespace ligature
