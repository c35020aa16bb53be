// A substep that is not finished leaves the thread as it was.

#include <gtest/gtest.h>

#include <array>
#include <string>

#include "tests/unit/rod/crumple.hpp"

namespace ligature::test {
namespace {

using physics::TimeLeft;
using physics::rod::kMaxHolds;

constexpr int kHeld = 77;  // node
constexpr double kStiffness_N_per_m = 500.0, kDamping_N_s_per_m = 1.0;

// A ball of thread thrown together; each tick is one substep of 1/16 ms. With `turning`, sweeps solve its contacts,
// without it Newton's method.
Rod thrown_ball(unsigned seed, bool turning, long work) {
  Numerics numerics;
  numerics.tick_s = 6.25e-5;
  numerics.substeps = numerics.max_substeps = 1;
  numerics.work = work;
  numerics.work_per_node = 0;
  const Parts parts{
      .twist = true, .contact = true, .friction = true, .adaptive = false, .roll = turning, .turning = turning};
  Rod rod(Material{}, numerics, parts, 154);
  crumple_apart(rod, seed, 20.0, 2.0);
  rod.grip(kHeld, kStiffness_N_per_m, kDamping_N_s_per_m, rod.state().x[kHeld], false, false);
  return rod;
}

// Does the tick's only substep wait? Then neither positions nor velocities may change, and the hand feels its spring
// and damper in this state.
bool waits_unchanged(Rod& rod, const TimeLeft& left, const std::string& which) {
  const std::vector<Vec> x = rod.state().x, v = rod.state().v;
  std::array<Vec, kMaxHolds> goals{};
  goals[0] = rod.state().holds[0].target;
  rod.tick(goals, left);
  if (rod.report().time_lost < 1.0 || rod.report().guard_events > 0) return false;
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_EQ(norm(rod.state().x[i] - x[i]), 0.0) << which << ", node " << i;
    EXPECT_EQ(norm(rod.state().v[i] - v[i]), 0.0) << which << ", node " << i;
  }
  const Vec force = kStiffness_N_per_m * (x[kHeld] - goals[0]) + kDamping_N_s_per_m * v[kHeld];
  EXPECT_LE(norm(rod.state().holds[0].force - force), 1e-9 * norm(force)) << which;
  return true;
}

TEST(Waiting, ForMoreWorkLeavesTheThreadAsItWas) {
  int waited = 0;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    Rod rod = thrown_ball(seed, false, 1'500'000);
    for (int k = 0; k < 100; ++k)
      waited += waits_unchanged(rod, TimeLeft{}, "seed " + std::to_string(seed) + ", tick " + std::to_string(k));
  }
  RecordProperty("waited", waited);
  EXPECT_GT(waited, 10);
  EXPECT_LT(waited, 390);  // in the other ticks the thread moves, so contacts have been solved before
}

// The clock ends the ticks at their first, second, third .. query.
TEST(Waiting, ForTimeLeavesTheThreadAsItWas) {
  for (const bool turning : {false, true}) {
    int waited = 0;
    Rod rod = thrown_ball(5, turning, 5'000'000);
    for (int k = 0; k < 20; ++k) rod.tick();
    for (int query = 0; query < 60; ++query) {
      waited += waits_unchanged(rod, TimeLeft::until_question(query), "query " + std::to_string(query));
      rod.tick();
    }
    RecordProperty(turning ? "waited_turning" : "waited", waited);
    EXPECT_GT(waited, 5) << turning;
  }
}

}  // namespace
}  // namespace ligature::test
