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
  const Plan calm, labouring{.labours = true}, released{.letting_go = true};
  for (const Row& row : std::vector<Row>{
           {"nothing happened", calm, after(0.5), {}, whole},
           {"the budget was nearly used", calm, after(0.95), {}, fewer},
           {"the clock ended the tick", calm, after(0.1, 0, 7), {}, fewer},
           {"it labours until a tick is cheap", labouring, after(0.5), {}, fewer},
           {"a tick was cheap", labouring, after(0.2), {}, whole},
           {"a substep waits: it goes on with its time step", calm, after(0.95, 1, -1, 13), {.waits = true}, 13},
           {"a hand lets go", calm, after(0.95), {.released = true}, 24},
           {"the thread still flies", released, after(0.95), {.node_m_per_s = 11.0}, 24},
           {"the thread has come down", released, after(0.1), {.node_m_per_s = 9.0}, whole},
           {"a fast hand is followed, whatever it costs", calm, after(0.95), {.hand_m_per_s = 0.4}, whole},
       }) {
    Situation now = row.now;
    now.nodes = 154;
    EXPECT_EQ(plan(row.last, row.report, now, kBalanced).substeps, row.substeps) << row.why;
  }
}

TEST(Plan, FineHasMoreSubstepsInEveryCase) {
  Numerics fine = kBalanced;
  fine.substeps = fine.max_substeps = 40;
  const Situation now{.nodes = 154};
  EXPECT_EQ(plan({}, after(0.0), now, fine).substeps, 40);
  EXPECT_EQ(plan({.labours = true}, after(0.95), now, fine).substeps, 25);
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

TEST(Plan, PaceIsThatOfTheHandsAndFadesWhenTheyStop) {
  Plan p = plan({}, after(0.5), {.hand_m_per_s = 0.2, .apart_m_per_s = 0.4, .nodes = 154}, kBalanced);
  EXPECT_DOUBLE_EQ(p.pace_m_per_s, 0.2);
  const Plan alone = plan(p, after(0.5), {.alone = true, .nodes = 154}, kBalanced);
  EXPECT_EQ(alone.pace_m_per_s, 0.0) << "nobody does work on it, so no error may be left to grow";
  for (int k = 0; k < 100; ++k) p = plan(p, after(0.5), {.nodes = 154}, kBalanced);
  EXPECT_LT(p.pace_m_per_s, 0.01);
  EXPECT_GT(p.pace_m_per_s, 0.0);
}

/// An inverse matrix serves for one time step only.
TEST(Plan, NewTimeStepNeedsANewMatrix) {
  const Situation now{.nodes = 154};
  EXPECT_FALSE(plan({}, after(0.5), now, kBalanced).new_matrix);
  EXPECT_TRUE(plan({}, after(0.95), now, kBalanced).new_matrix);
}

TEST(Patience, EndsAndComesBack) {
  Patience p;
  int waited = 0;
  while (p.newton_failed(false, false)) p.put_off(), ++waited;
  EXPECT_EQ(waited, static_cast<int>(tuning.patience));
  EXPECT_TRUE(p.sweeps_only());
  p.moved();
  EXPECT_FALSE(p.sweeps_only());
  EXPECT_FALSE(p.waits());
  int less = 0;
  while (p.newton_failed(false, false)) p.put_off(), ++less;
  EXPECT_LT(less, waited) << "waiting has not helped";
  p.moved();
  for (int k = 0; k < 12; ++k) p.newton_solved();
  int again = 0;
  while (p.newton_failed(false, false)) p.put_off(), ++again;
  EXPECT_EQ(again, waited);
}

TEST(Patience, SystemWithoutSolutionWaitsOnlyIfSweepsCannotBePaid) {
  Patience p;
  EXPECT_FALSE(p.newton_failed(true, false));
  EXPECT_TRUE(p.sweeps_only());
  Patience q;
  EXPECT_TRUE(q.newton_failed(true, true));
}

/// However often waiting for a solution has failed, a substep may wait again some time later. Otherwise such a knot
/// would be solved only by sweeps from then on.
TEST(Patience, NeverEndsForGood) {
  Patience p;
  for (int k = 0; k < 100; ++k) {
    while (p.newton_failed(false, false)) p.put_off();
    p.moved();
  }
  int moved = 0;
  while (!p.lasts() && moved < 1000) p.moved(), ++moved;
  EXPECT_LT(moved, 1000);
}

}  // namespace
}  // namespace ligature::test
