// Knots of two throws under too small a budget, held and released: time lost, cost at rest, and the mesh where strands
// touch.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/unit/rod/tightening.hpp"

namespace ligature::test {
namespace {

// A square knot drawn tight and held. Two rules keep the time lost low: the solver starts from the old impulses
// unchanged, not projected onto the friction cones; and contact points do not oscillate (touch.hpp). Without both, 50 %
// of the time was lost at 0.2 m/s; without the first 20 % (0.15 m/s), without the second 74 % (0.22 m/s).
TEST(Hold, OfTwoThrowsLosesHardlyAnyTime) {
  for (const double speed : {0.15, 0.2, 0.22, 0.23}) {
    Tightening pull({}, "suture-3-0-square.toml");
    for (int k = 0; k < 100; ++k) pull.tick(0.0);
    for (int k = 0; k < 1000 && Tightening::force(pull.sim()) < 5.0; ++k) pull.tick(speed);
    for (int k = 0; k < 400; ++k) pull.tick(0.0);
    double lost = 0.0;
    int guarded = 0;
    for (int k = 0; k < 500; ++k) {
      pull.tick(0.0);
      lost += pull.sim().rod().report().time_lost;
      guarded += pull.sim().rod().report().guard_events;
    }
    EXPECT_LT(lost / 500, 0.05) << speed;
    RecordProperty("lost_" + std::to_string(speed), std::to_string(lost / 500));
    EXPECT_EQ(guarded, 0) << speed;
  }
}

// A held surgeon's knot is slackened slowly, so half of its contacts change between stick, slip and open. Newton's
// steps cycle if their proximal term (contact_newton.hpp) is dropped as soon as no contact changes its kind.
TEST(Hold, OfTwoThrowsIsLetOffWithoutStandingStill) {
  double lost = 0.0;
  int ticks = 0;
  for (const double speed : {0.17, 0.2}) {
    Tightening pull({}, "suture-3-0-surgeons.toml");
    for (int k = 0; k < 100; ++k) pull.tick(0.0);
    for (int k = 0; k < 1000 && Tightening::force(pull.sim()) < 5.0; ++k) pull.tick(speed);
    for (int k = 0; k < 400; ++k) pull.tick(0.0);
    for (int k = 0; k < 500 && Tightening::force(pull.sim()) > 0.5; ++k, ++ticks) {
      pull.tick(-0.02);
      lost += pull.sim().rod().report().time_lost;
    }
  }
  RecordProperty("lost", std::to_string(lost / ticks));
  EXPECT_GT(ticks, 300);
  EXPECT_LT(lost / ticks, 0.35);
}

// At rest the solver converges again in each substep, even with about half the budget. A single hold scatters (time
// lost 0 or 0.07), so ten holds with three budgets each are averaged: 0.02, and 0.03 without a fair share of the budget
// per substep. The limit below only bounds the time lost; it cannot show that the budget is shared fairly.
TEST(Hold, OfTwoThrowsCanDoWithHalfTheWork) {
  double lost = 0.0;
  for (int i = 0; i < 10; ++i) {
    Tightening pull({}, "suture-3-0-square.toml");
    for (int k = 0; k < 100; ++k) pull.tick(0.0);
    for (int k = 0; k < 1000 && Tightening::force(pull.sim()) < 5.0; ++k) pull.tick(0.165 + 0.007 * i);
    for (int k = 0; k < 600; ++k) pull.tick(0.0);
    for (const long work : {3'615'000, 2'615'000, 2'115'000}) {
      RodSimulation twin = pull.sim();
      twin.rod().numerics().work = work;
      for (int k = 0; k < 200; ++k) {
        twin.tick(pull.tools());
        if (k >= 50) lost += twin.rod().report().time_lost / (10 * 450);
      }
    }
  }
  RecordProperty("lost", std::to_string(lost));
  EXPECT_LT(lost, 0.05);
}

// A substep takes no more than its fair share of the tick's budget if it has a solution that is good enough. Mean time
// lost over eight pulls of a surgeon's knot: 0.21 (standard error 0.01); 0.31 if each substep may take all that is
// left.
TEST(Labour, IsSharedFairly) {
  double lost = 0.0;
  for (int i = 0; i < 8; ++i) {
    Tightening pull({}, "suture-3-0-surgeons.toml");
    for (int k = 0; k < 100; ++k) pull.tick(0.0);
    double sum = 0.0;
    int ticks = 0;
    for (; ticks < 1000 && Tightening::force(pull.sim()) < 5.0; ++ticks) {
      pull.tick(0.165 + 0.009 * i);
      sum += pull.sim().rod().report().time_lost;
    }
    lost += sum / ticks / 8;
  }
  RecordProperty("lost", std::to_string(lost));
  EXPECT_LT(lost, 0.25);
}

// A surgeon's knot drawn tight by two hands and held for 0.7 s.
Tightening held(double speed) {
  Tightening pull({}, "suture-3-0-surgeons.toml");
  for (int k = 0; k < 100; ++k) pull.tick(0.0);
  for (int k = 0; k < 1000 && Tightening::force(pull.sim()) < 5.0; ++k) pull.tick(speed);
  for (int k = 0; k < 700; ++k) pull.tick(0.0);
  return pull;
}

// The solver's tolerance has a lower bound, set by single precision. If it were always a tenth of the motion, some
// knots at rest would spend their whole budget in every tick on differences of 5 um/s. Two copies of the same state are
// compared, because which holds do so is random (work ratio 0.72; one of the five spends all of it in either copy).
TEST(Hold, OfTwoThrowsAtRestIsCheap) {
  double work = 0.0, finer = 0.0;
  for (const double speed : {0.16, 0.18, 0.2, 0.22, 0.24}) {
    Tightening pull = held(speed);
    RodSimulation twin = pull.sim();
    twin.rod().numerics().newton_m_per_s = 0.0;
    for (int k = 0; k < 200; ++k) {
      pull.tick(0.0);
      twin.tick(pull.tools());
      work += static_cast<double>(pull.sim().rod().report().work);
      finer += static_cast<double>(twin.rod().report().work);
    }
  }
  EXPECT_LT(work, 0.85 * finer);
}

// A loop of thread that touches the thread beside a tight knot with only 0.1 mN is meshed there as finely as the knot.
TEST(FineZone, ReachesTheLoopThatTouches) {
  for (const double speed : {0.16, 0.19, 0.22, 0.24}) {
    Tightening pull = held(speed);
    const auto& mesh = pull.sim().rod().state().mesh;
    double longest = 0.0;
    int loaded = 0;
    for (const auto& c : pull.sim().rod().contact_set().contacts()) {
      if (dot(c.p, c.p) == 0.0) continue;
      ++loaded;
      for (const int k : {0, 2}) longest = std::max(longest, mesh.rest[static_cast<std::size_t>(c.node[k])]);
    }
    EXPECT_GT(loaded, 20);
    EXPECT_LT(longest, 1.2 * 3e-4) << speed;
    RecordProperty("segment_" + std::to_string(speed), std::to_string(longest / 3e-4));
  }
}

// With suture.accuracy = "fast" a tick has ten substeps, also when the budget runs out. With six, the three square
// knots pulled to 5 N had 59, 2 and 23 guard events, were held with 0.02, 3.6 and 1.9 N, and lost no less time.
TEST(Labour, LeavesTenSubsteps) {
  for (const double speed : {0.19, 0.2, 0.21}) {
    Tightening pull({"suture.accuracy=\"fast\""}, "suture-3-0-square.toml");
    int guard = 0, fewest = 100;
    const auto tick = [&](double v) {
      pull.tick(v);
      const auto& report = pull.sim().rod().report();
      guard += report.guard_events, fewest = std::min(fewest, report.substeps);
    };
    for (int k = 0; k < 100; ++k) tick(0.0);
    for (int k = 0; k < 1000 && Tightening::force(pull.sim()) < 5.0; ++k) tick(speed);
    for (int k = 0; k < 500; ++k) tick(0.0);
    EXPECT_EQ(guard, 0) << speed;
    EXPECT_EQ(fewest, 10);
    EXPECT_GT(Tightening::force(pull.sim()), 4.0) << speed;
  }
}

// Largest approach velocity of loaded contacts beyond the allowed one, m/s.
double lack(const RodSimulation& sim) {
  const auto& state = sim.rod().state();
  double worst = 0.0;
  for (const auto& c : sim.rod().contact_set().contacts()) {
    if (dot(c.p, c.p) == 0.0) continue;
    physics::rod::Vec u = -c.surface;
    for (int j = 0; j < c.count; ++j) u += c.w[j] * state.v[static_cast<std::size_t>(c.node[j])];
    worst = std::max(worst, c.target - c.soft * dot(c.p, c.n) - dot(u, c.n));
  }
  return worst;
}

// Nodes are moved only with velocities that satisfy the contacts in the current matrix, not in the older one that
// Newton's method uses. With the older one a held square knot converged to 1 mm/s, but its strands approached at 0.16
// m/s and overlapped by 0.56 d.
TEST(Hold, MovesOnlyWhatIsSettledInTheTrueMatrix) {
  Tightening pull({}, "suture-3-0-square.toml");
  pull.sim().rod().numerics().work = 3'700'000;
  auto& tool = pull.tools()[1];
  for (int k = 0; k < 100; ++k) pull.sim().tick(pull.tools());
  tool.v_WT.x() = 0.18;
  for (int k = 0; k < 2000 && Tightening::force(pull.sim()) < 5.0; ++k) {
    tool.p_WT.x() += 1e-3 * tool.v_WT.x();
    pull.sim().tick(pull.tools());
  }
  tool.v_WT.x() = 0.0;
  double worst = 0.0, overlap_m = 0.0;
  int moved = 0;
  for (int k = 0; k < 1000; ++k) {
    pull.sim().tick(pull.tools());
    if (k < 300) continue;
    overlap_m = std::max(overlap_m, -pull.sim().diagnostics().min_gap_m);
    // If time was lost, the contacts in the report belong to a substep that was not carried out.
    if (pull.sim().rod().report().time_lost > 0.0) continue;
    ++moved;
    worst = std::max(worst, lack(pull.sim()));
  }
  EXPECT_GT(moved, 500);
  EXPECT_LT(worst, 1.5e-3);
  EXPECT_LT(overlap_m, 0.1 * 3e-4);
  RecordProperty("lack_m_per_s", std::to_string(worst));
  RecordProperty("overlap_d", std::to_string(overlap_m / 3e-4));
}

}  // namespace
}  // namespace ligature::test
