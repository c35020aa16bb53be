// The plan of a tick, tested without a thread: what happened in the tick before, and how the rod changes its plan.

#include "firmware/physics/rod/plan.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace ligature::test {
namespace {

using namespace physics::rod;

constexpr Numerics kBalanced;
const long kBudget = kBalanced.budget(154, 0.0);

TickReport after(double share_of_budget, int cut_short = 0, int cut_at = -1, int substeps = kBalanced.substeps) {
  TickReport r;
  r.work = static_cast<long>(share_of_budget * static_cast<double>(kBudget));
  r.cut_short = cut_short, r.cut_at = cut_at, r.substeps = substeps;
  return r;
}

struct Row {
  const char* why;
  Plan last;
  TickReport report;
  Situation now;
  int substeps;
};

TEST(Plan, SubstepsFollowTheTable) {
  const int whole = kBalanced.substeps, fewer = tuning.fewest_substeps;
  const Plan calm;
  for (const Row& row : std::vector<Row>{
           {"nothing happened", calm, after(0.2), {}, whole},
           {"a large share of the budget was used", calm, after(0.3), {}, fewer},
           {"the clock ended the tick", calm, after(0.1, 0, 7), {}, fewer},
           {"a substep waits: it goes on with its time step", calm, after(0.95, 1, -1, 13), {.waits = true}, 13},
           {"a hand lets go", calm, after(0.95), {.released = true}, whole},
           {"the thread flies, as after a release", calm, after(0.95), {.node_d = whole + 0.1}, whole},
           {"the thread has come down", calm, after(0.95), {.node_d = whole - 0.1}, fewer},
           {"a fast hand is followed, whatever it costs", calm, after(0.95), {.hand_d = 1.1}, whole},
       }) {
    Situation now = row.now;
    now.nodes = 154;
    EXPECT_EQ(plan(row.last, row.report, now, kBalanced).substeps, row.substeps) << row.why;
  }
}

TEST(Plan, AFastHandHasALargerBudget) {
  const auto budget = [](double hand_d) {
    return plan({}, after(0.2), {.hand_d = hand_d, .nodes = 154}, kBalanced).budget;
  };
  EXPECT_EQ(budget(0.0), kBudget);
  EXPECT_EQ(budget(1.0), kBudget);
  EXPECT_EQ(budget(1.1), static_cast<long>((1.0 + tuning.rush) * static_cast<double>(kBudget)));
}

TEST(Plan, FineHasMoreSubstepsInEveryCase) {
  Numerics fine = kBalanced;
  fine.substeps = fine.max_substeps = 40;
  const Situation now{.nodes = 154};
  EXPECT_EQ(plan({}, after(0.0), now, fine).substeps, 40);
  EXPECT_EQ(plan({}, after(0.95), now, fine).substeps, 20);
}

TEST(Plan, ToleranceGrowsAfterTicksCutShortOnly) {
  const Situation now{.nodes = 154};
  Plan p;
  for (int k = 0; k < 20; ++k) {
    const double before = p.leniency;
    p = plan(p, after(0.5, 1), now, kBalanced);
    EXPECT_GE(p.leniency, before);
  }
  EXPECT_EQ(p.leniency, tuning.most_leniency);
  for (int k = 0; k < 40; ++k) p = plan(p, after(0.5), now, kBalanced);
  EXPECT_EQ(p.leniency, 1.0);
}

TEST(Plan, PaceIsHalfTheSpeedBetweenTheHands) {
  EXPECT_DOUBLE_EQ(plan({}, after(0.5), {.apart_m_per_s = 0.4, .nodes = 154}, kBalanced).pace_m_per_s, 0.2);
  EXPECT_EQ(plan({.pace_m_per_s = 0.2}, after(0.5), {.nodes = 154}, kBalanced).pace_m_per_s, 0.0);
}

/// An inverse matrix serves for one time step only.
TEST(Plan, NewTimeStepNeedsANewMatrix) {
  const Situation now{.nodes = 154};
  EXPECT_FALSE(plan({}, after(0.2), now, kBalanced).new_matrix);
  EXPECT_TRUE(plan({}, after(0.95), now, kBalanced).new_matrix);
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
