// The work of a tick is bounded in any state: it is counted in instructions that are estimated before each piece of
// work (rod/work.hpp), not measured as time.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/crossings.hpp"
#include "tests/unit/rod/crumple.hpp"

namespace ligature::test {
namespace {

using physics::rod::kMaxHolds;

struct Hostile {
  long most_work = 0, pairs = 0, crossings = 0, ticks_given_up = 0;
  bool finite = true;
};

// Moves the hands apart at hand_m_per_s; each tick is a single substep and is checked for crossings.
Hostile attack(Rod rod, unsigned seed, double ball, double thrown_m_per_s, double hand_m_per_s, int ticks) {
  crumple(rod, seed, ball, thrown_m_per_s);
  const int n = rod.state().nodes();
  std::array<Vec, kMaxHolds> goals{};
  rod.grip(n / 4, 1000.0, 0.5, rod.state().x[static_cast<std::size_t>(n / 4)]);
  rod.grip(3 * n / 4, 1000.0, 0.5, rod.state().x[static_cast<std::size_t>(3 * n / 4)]);
  for (std::size_t h = 0; h < 2; ++h) goals[h] = rod.state().holds[h].target;
  Hostile seen;
  for (int k = 0; k < ticks; ++k) {
    const double way_m = hand_m_per_s * rod.numerics().tick_s;
    goals[0] -= make(way_m, 0, 0), goals[1] += make(way_m, 0, 0);
    const std::vector<Vec> before = rod.state().x;
    rod.tick(goals);
    seen.most_work = std::max(seen.most_work, rod.report().work);
    seen.ticks_given_up += rod.report().time_lost > 0.0;
    seen.pairs = std::max(seen.pairs, static_cast<long>(rod.contact_set().pairs.size()));
    const auto& after = rod.state().x;
    for (const auto& x : after) seen.finite &= std::isfinite(x[0] + x[1] + x[2]);
    if (rod.report().substeps == 1) seen.crossings += crossings_of_step(before, after);
  }
  return seen;
}

long budget_of(const Numerics& numerics, int nodes) { return numerics.budget(nodes); }

TEST(Work, NoStateCostsMoreThanTheBudget) {  // 154 to 2000 nodes, at rest and thrown, hands at up to 100 m/s
  for (const auto& [nodes, ball] : {std::pair{154, 6.0}, {154, 20.0}, {500, 6.0}, {500, 20.0}, {2000, 60.0}}) {
    for (const double thrown : {0.0, 10.0}) {
      for (const double hands : {0.0, 100.0}) {
        Numerics numerics;
        const Rod rod(Material{}, numerics, Parts{true, true, true, false, nodes == 154}, nodes);
        const Hostile seen = attack(rod, 7, ball, thrown, hands, 12);
        EXPECT_LE(seen.most_work, budget_of(numerics, nodes)) << nodes << ' ' << thrown << ' ' << hands;
        EXPECT_GT(seen.most_work, numerics.work / 2);
        EXPECT_TRUE(seen.finite);
      }
    }
  }
}

TEST(Work, NothingCrossesInACrumpledBall) {  // one substep per tick, so that every step is checked
  Numerics numerics;
  numerics.tick_s = 6.25e-5;
  numerics.substeps = numerics.max_substeps = 1;
  Rod rod(Material{}, numerics, Parts{false, true, true, false, false}, 154);
  rod.hold_mesh(true);
  long pairs = 0, given_up = 0;
  for (const auto& [seed, ball] : {std::pair{1U, 6.0}, {2U, 6.0}, {3U, 20.0}, {4U, 20.0}}) {
    const Hostile seen = attack(rod, seed, ball, 2.0, 100.0, 60);
    EXPECT_LE(seen.most_work, budget_of(numerics, 154));
    EXPECT_EQ(seen.crossings, 0);
    EXPECT_TRUE(seen.finite);
    pairs = std::max(pairs, seen.pairs);
    given_up += seen.ticks_given_up;
  }
  EXPECT_GT(pairs, 1500);
  EXPECT_GT(given_up, 0);
}

TEST(Work, SaysWhatItGaveUp) {  // what is given up is time: unconverged substeps wait, and contacts are kept
  Numerics numerics;
  numerics.work = 2'700'000;
  Rod rod(Material{}, numerics, Parts{false, true, true, false, false}, 154);
  crumple(rod, 5, 20.0, 0.0);
  rod.tick();
  const auto& r = rod.report();
  EXPECT_GT(r.time_lost, 0.0) << rod.contact_set().pairs.size();
  EXPECT_EQ(r.rows_left_out, 0) << r.contacts;
  EXPECT_LE(rod.report().work, numerics.budget(154));
}

}  // namespace
}  // namespace ligature::test
