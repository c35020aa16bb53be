// Random attacks: what the motors really do to a hand under random faults. By default forty runs; LIGATURE_ATTACK_RUNS
// and LIGATURE_ATTACK_SEED select others. docs/measurements/attack.md has the results of many runs.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>

#include "tests/integration/virtual_rig/attack_findings.hpp"

namespace ligature {
namespace {

std::uint64_t number(const char* name, std::uint64_t otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

void print(const Findings& found) {
  std::printf("%d runs: %d above 0.5 N, %d with encoders that lie, %d with a fault, %d did not start\n", found.runs,
              found.pushed, found.lying, found.faulted, found.refused);
  std::printf("true force within the promise up to %.3f N, step up to %.3f N\nfaults (number: runs):", found.peak_N,
              found.step_N);
  for (const auto& [fault, runs] : found.faults) std::printf(" %d: %d", fault, runs);
  std::printf("\n| not kept | cause | runs | SYNCs | worst | its seed, tick |\n|---|---|---|---|---|---|\n");
  for (const auto& [exception, times] : found.exceptions)
    std::printf("| %s | %s | %d | %d | %.2f | %llu, %zu |\n", exception.promise.c_str(), exception.cause.c_str(),
                times.runs, times.syncs, times.worst, static_cast<unsigned long long>(times.seed), times.tick);
}

void expect_explained(const AttackPlan& plan, const Findings& found) {
  for (const auto& [exception, times] : found.exceptions)
    EXPECT_NE(exception.cause, kUnexplained) << exception.promise << " of hand " << times.hand << ", worst "
                                             << times.worst << " at tick " << times.tick << "; " << plan.text();
}

/// Number of periods in which a hand's motors pushed after the first fault, when its bus is flooded during a pull.
int ticks_of_old_torque(std::uint64_t seed, int frames_a_tick) {
  AttackPlan plan = AttackPlan::pulls(seed);
  plan.foreign.push_back(AttackPlan::flood(0, 1500, 400, frames_a_tick));
  AttackedRig attacked(plan);
  EXPECT_FALSE(attacked.run());
  const auto& records = attacked.rig.records;
  const auto faulted = std::ranges::find_if(records, [](const auto& r) { return r.fault != 0; });
  const auto& tips = attacked.rig.truth[0].tips();
  int ticks = 0;
  for (auto k = static_cast<std::size_t>(faulted - records.begin()); k < tips.size(); ++k)
    if (tips[k].permille != std::array<std::int16_t, 3>{})
      ticks = static_cast<int>(k - static_cast<std::size_t>(faulted - records.begin())) + 1;
  return ticks;
}

TEST(RandomAttack, NoTorqueWaitsInAQueueWhileTheBusIsFlooded) {
  for (int frames = 3; frames <= 10; ++frames) {
    const int ticks = ticks_of_old_torque(static_cast<std::uint64_t>(frames), frames);
    std::printf("%d frames a tick: %d ticks\n", frames, ticks);
    EXPECT_LE(ticks, kTicksOfFlood) << frames << " frames a tick";
  }
}

/// Loose hands jump while holding a stiff thread, and one axis of the left hand starts to count backwards.
TEST(RandomAttack, AnAxisThatReversesInAHardPullKeepsToThePromises) {
  Findings all;
  for (std::uint64_t seed = 20; seed <= 40; ++seed) {
    AttackPlan plan = AttackPlan::pulls(seed);
    plan.coupling = 30.0;
    plan.tightness = {0.3, 0.3};
    plan.amplitude_m = {0.03, 0.03};
    plan.jumps = true;
    plan.faults[0].emplace();
    plan.faults[0]->kind = scene::FaultKind::kReverse;
    plan.faults[0]->node = static_cast<int>(1 + seed % 3);
    plan.faults[0]->from_s = 0.9 + 0.06 * static_cast<double>(seed % 18);
    AttackedRig attacked(plan);
    ASSERT_EQ(attacked.run(), std::nullopt);
    const Findings found = judge(plan, attacked.rig);
    expect_explained(plan, found);
    all.add(found);
  }
  print(all);
  EXPECT_GT(all.peak_N, 2.5) << "a pull that is weak says nothing";
}

TEST(RandomAttack, EveryForceIsWithinItsPromiseOrItsCauseIsNamed) {
  const std::uint64_t runs = number("LIGATURE_ATTACK_RUNS", 40), first = number("LIGATURE_ATTACK_SEED", 1);
  Findings all;
  for (std::uint64_t seed = first; seed < first + runs; ++seed) {
    const AttackPlan plan(seed);
    AttackedRig attacked(plan);
    Findings found;
    if (attacked.run()) {
      found.runs = found.refused = 1;
    } else {
      found = judge(plan, attacked.rig);
    }
    expect_explained(plan, found);
    all.add(found);
  }
  print(all);
  if (runs < 30) return;  // a single seed is being examined
  EXPECT_GT(all.pushed, all.runs / 3) << "an attack on a rig that does not push says nothing";
  EXPECT_GT(all.lying, 0) << "36 of 100 attacks are of this kind, so none of 40 happens once in 50 million";
}

}  // namespace
}  // namespace ligature
