// A substep that is not finished leaves the thread as it was; the next tick begins with what is known.

#include <gtest/gtest.h>

#include <array>
#include <string>

#include "tests/unit/rod/crumple.hpp"

namespace ligature::test {
namespace {

using physics::TimeLeft;
using physics::rod::kMaxHolds;

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
  return rod;
}

// Was the tick's only substep not finished? Then neither positions nor velocities may have changed.
bool waited_unchanged(Rod& rod, const TimeLeft& left, const std::string& which) {
  const std::vector<Vec> x = rod.state().x, v = rod.state().v;
  rod.tick(std::array<Vec, kMaxHolds>{}, left);
  if (rod.report().time_lost < 1.0 || rod.report().guard_events > 0) return false;
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_EQ(norm(rod.state().x[i] - x[i]), 0.0) << which << ", node " << i;
    EXPECT_EQ(norm(rod.state().v[i] - v[i]), 0.0) << which << ", node " << i;
  }
  return true;
}

TEST(Waiting, ForMoreWorkLeavesTheThreadAsItWas) {
  int waited = 0;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    Rod rod = thrown_ball(seed, false, 1'500'000);
    for (int k = 0; k < 100; ++k)
      waited += waited_unchanged(rod, TimeLeft{}, "seed " + std::to_string(seed) + ", tick " + std::to_string(k));
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
      waited += waited_unchanged(rod, TimeLeft::until_question(query), "query " + std::to_string(query));
      rod.tick();
    }
    RecordProperty(turning ? "waited_turning" : "waited", waited);
    EXPECT_GT(waited, 5) << turning;
  }
}

// Contacts at rest keep their forces, so their impulses are proportional to the time step. When a tick has eight
// substeps instead of sixteen, a heavy thread on a desk needs hardly more passes than later on: 14 instead of 12. With
// unchanged impulses it needs 101.
TEST(Waiting, ForcesAtRestDoNotDependOnTheTimeStep) {
  Material m;
  m.length_m = 0.03;
  Rod rod(m, Numerics{}, Parts{.twist = false, .contact = false, .friction = true, .world = true}, 30);
  rod.has_floor = true;
  rod.gravity = make(0, 0, -981.0);
  for (auto& x : rod.state().x) x += make(0, 0, m.radius_m);
  rod.moved();
  for (int k = 0; k < 1000; ++k) rod.tick();
  ASSERT_EQ(rod.report().substeps, 16);
  rod.numerics().substeps = 8;
  rod.tick();
  const int first = rod.report().passes;
  for (int k = 0; k < 100; ++k) rod.tick();
  ASSERT_EQ(rod.report().substeps, 8);
  RecordProperty("first", first);
  RecordProperty("later", rod.report().passes);
  EXPECT_LE(first, 2 * rod.report().passes);
}

}  // namespace
}  // namespace ligature::test
