// The number of time steps in a tick, and how long one may wait, tested without a thread.

#include "firmware/physics/rod/plan.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace ligature::test {
namespace {

using namespace physics::rod;

constexpr Numerics kBalanced;
const long kBudget = kBalanced.budget(154);

TickReport after(double share_of_budget, int substeps = kBalanced.substeps, int cut_at = -1) {
  TickReport r;
  r.work = static_cast<long>(share_of_budget * static_cast<double>(kBudget));
  r.substeps = substeps, r.cut_at = cut_at;
  return r;
}

TEST(Substeps, FollowTheTable) {
  const int whole = kBalanced.substeps, fewer = tuning.fewest_substeps;
  struct Row {
    const char* why;
    Situation now;
    TickReport last;
    int substeps;
  };
  for (const Row& row : std::vector<Row>{
           {"nothing happened", {}, after(0.1), whole},
           {"a large share of the budget was used", {}, after(0.2), fewer},
           {"the clock ended the tick", {}, after(0.1, whole, 7), fewer},
           {"a substep waits: it goes on with its time step", {.waits = true}, after(0.95, 13), 13},
           {"a hand lets go", {.released = true}, after(0.95), whole},
           {"the thread flies, as after a release", {.node_d = whole + 0.1}, after(0.95), whole},
           {"a hand is fast", {.hand_d = 1.1}, after(0.95), whole},
           {"a hand is not fast: one diameter in a tick, rounded up", {.hand_d = 1.0 + 1e-12}, after(0.95), fewer},
           {"the thread has come down", {.node_d = whole - 0.1}, after(0.95), fewer},
           {"a substep waits in a thread that flies", {.node_d = whole + 0.1, .waits = true}, after(0.95, 13), whole},
       })
    EXPECT_EQ(substeps_of(row.now, row.last, kBudget, kBalanced), row.substeps) << row.why;
}

TEST(Substeps, FollowTheSetting) {
  Numerics fine, fast;
  fine.substeps = fine.max_substeps = 40;
  fast.substeps = 10, fast.max_substeps = 16;
  EXPECT_EQ(substeps_of({}, after(0.0), kBudget, fine), 40);
  EXPECT_EQ(substeps_of({}, after(0.95), kBudget, fine), 20);
  EXPECT_EQ(substeps_of({}, after(0.95), kBudget, fast), 10) << "no fewer than ten";
  EXPECT_EQ(substeps_of({.released = true}, after(0.0), kBudget, fast), 16);
}

TEST(Substeps, NewOnesAndFastMotionNeedANewMatrix) {
  EXPECT_FALSE(needs_new_matrix({}, 16, 16, kBalanced));
  EXPECT_TRUE(needs_new_matrix({}, 16, 10, kBalanced));
  EXPECT_TRUE(needs_new_matrix({.hand_d = 1.1}, 16, 16, kBalanced));
  EXPECT_TRUE(needs_new_matrix({.released = true}, 16, 16, kBalanced));
  EXPECT_TRUE(needs_new_matrix({.node_d = 16.1}, 16, 16, kBalanced));
  EXPECT_FALSE(needs_new_matrix({.hand_d = 1.1, .waits = true}, 16, 16, kBalanced)) << "the substep is continued";
}

TEST(Tolerance, GrowsWithHandsOrThreadAndIsSmallInAThreadThatHardlyMoves) {
  const Numerics n;
  const double rest = n.settled_m_per_s;
  const auto grown = [&](double speed) { return rest + n.settled_share * speed; };
  EXPECT_DOUBLE_EQ(tolerance({0.2, 0.0, 1.0}, false, n), grown(0.2)) << "hands that part";
  EXPECT_DOUBLE_EQ(tolerance({0.0, 1.0, 1.0}, false, n), grown(tuning.stir)) << "a thread that moves by itself";
  EXPECT_DOUBLE_EQ(tolerance({0.2, 1.0, 1.0}, false, n), grown(0.2)) << "the larger of the two";
  EXPECT_DOUBLE_EQ(tolerance({0.0, 0.0, 1.0}, false, n), rest) << "a thread that is carried along";
  EXPECT_DOUBLE_EQ(tolerance({0.0, 1.0, 1.0}, true, n), rest) << "a thread that is alone";
  EXPECT_DOUBLE_EQ(tolerance({0.2, 0.0, 1e-3}, false, n), tuning.creep * 1e-3) << "slow nodes";
  EXPECT_DOUBLE_EQ(tolerance({0.2, 0.0, 0.0}, false, n), tuning.creep * rest) << "nodes at rest";
}

TEST(Patience, EndsAndIsWholeForTheNextSubstep) {
  Patience p;
  for (int substep = 0; substep < 3; ++substep) {
    int waited = 0;
    while (p.lasts()) p.put_off(), ++waited;
    EXPECT_EQ(waited, tuning.patience);
    EXPECT_TRUE(p.waits() && p.sweeps_only());
    p.moved();
    EXPECT_FALSE(p.waits() || p.sweeps_only());
  }
}

TEST(Patience, NewtonIsNotTriedAgainWhereItHasFailed) {
  Patience p;
  p.newton_failed();
  EXPECT_TRUE(p.sweeps_only());
  EXPECT_TRUE(p.lasts()) << "the sweeps may wait for the work of the next tick";
  p.moved();
  EXPECT_FALSE(p.sweeps_only());
}

}  // namespace
}  // namespace ligature::test
