// Knots of two throws under too small a budget: time lost, cost at rest, and the mesh where strands touch.
//
// Rounding decides how a single pull goes, so no claim here is about one pull. Each test draws the speeds of several
// pulls (LIGATURE_TEST_SEED draws others), and judges a mean or a share of them. What must hold in every pull is
// asserted for every pull.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/support/random.hpp"
#include "tests/unit/rod/tightening.hpp"

namespace ligature::test {
namespace {

/// Speeds of a hand in n pulls, m/s, one in each of n equal parts of the range.
std::vector<double> speeds(int n, double low, double high, std::uint64_t seed) {
  Random random(seed);
  std::vector<double> all;
  for (int i = 0; i < n; ++i) all.push_back(low + (high - low) * (i + random.share()) / n);
  return all;
}

/// Pulls a shipped loose knot to 5 N at this speed, after 0.1 s of rest. `each` is called after each tick of the pull.
template <class Each>
Tightening pulled(const char* scene, double speed, const std::vector<std::string>& overrides, Each each) {
  Tightening pull(overrides, scene);
  for (int k = 0; k < 100; ++k) pull.tick(0.0);
  for (int k = 0; k < 1000 && Tightening::force(pull.sim()) < 5.0; ++k) {
    pull.tick(speed);
    each(pull.sim());
  }
  return pull;
}
/// 72 % of the contact budget of `balanced`, as a weak machine may have.
const std::vector<std::string> kSmallBudget{"suture.work_instructions=4685000"};

Tightening pulled(const char* scene, double speed) {
  return pulled(scene, speed, kSmallBudget, [](const RodSimulation&) {});
}

constexpr const char* kSquare = "suture-3-0-square.toml";
constexpr const char* kSurgeons = "suture-3-0-surgeons.toml";

/// Share of the time lost in the next ticks, in which the hands move at this speed. Adds the number of guard events to
/// `guard`, if it is given.
double lost_share(Tightening& pull, int ticks, double speed = 0.0, int* guard = nullptr) {
  double lost = 0.0;
  for (int k = 0; k < ticks; ++k) {
    pull.tick(speed);
    lost += pull.sim().rod().report().time_lost;
    if (guard != nullptr) *guard += pull.sim().rod().report().guard_events;
  }
  return lost / ticks;
}

// Two rules keep the time lost in a hold low: the solver starts from the old impulses unchanged, not projected onto the
// friction cones (20 % were lost without this, after a pull at 0.15 m/s); and contact points do not oscillate
// (touch.hpp, Touch.*).
TEST(Hold, OfTwoThrowsLosesHardlyAnyTime) {
  double mean = 0.0;
  const auto drawn = speeds(8, 0.15, 0.24, 601);
  for (const double speed : drawn) {
    Tightening pull = pulled(kSquare, speed);
    for (int k = 0; k < 400; ++k) pull.tick(0.0);
    int guard = 0;
    const double lost = lost_share(pull, 500, 0.0, &guard);
    mean += lost / 8;
    EXPECT_EQ(guard, 0) << speed;
    RecordProperty("lost_" + std::to_string(speed), std::to_string(lost));
  }
  RecordProperty("mean", std::to_string(mean));
  EXPECT_LT(mean, 0.05);
}

// A held surgeon's knot is slackened slowly, so half of its contacts change between stick, slip and open.
TEST(Hold, OfTwoThrowsIsSlackenedInTime) {
  double lost = 0.0;
  int ticks = 0;
  for (const double speed : speeds(4, 0.16, 0.24, 602)) {
    Tightening pull = pulled(kSurgeons, speed);
    for (int k = 0; k < 400; ++k) pull.tick(0.0);
    for (int k = 0; k < 500 && Tightening::force(pull.sim()) > 0.5; ++k, ++ticks) lost += lost_share(pull, 1, -0.02);
  }
  RecordProperty("lost", std::to_string(lost / ticks));
  EXPECT_GT(ticks, 600);
  EXPECT_LT(lost / ticks, 0.15);
}

// A substep that has a good enough solution takes no more than its fair share of the tick's budget. The mean share of
// time lost in pulls of a surgeon's knot was 0.17 when each substep could take all that is left, and 0.18 when the
// speed of the hands did not loosen the tolerance. In eight draws of eight pulls it was 0.119 to 0.137 (mean 0.131,
// standard deviation 0.006). The mean of 24 pulls, with 0.0036, is above 0.155 less than once in a million draws.
TEST(Labour, IsSharedFairly) {
  constexpr int kPulls = 24;
  double lost = 0.0;
  for (const double speed : speeds(kPulls, 0.161, 0.233, 604)) {
    double sum = 0.0;
    int ticks = 0;
    pulled(kSurgeons, speed, kSmallBudget,
           [&](const RodSimulation& sim) { sum += sim.rod().report().time_lost, ++ticks; });
    lost += sum / ticks / kPulls;
  }
  RecordProperty("lost", std::to_string(lost));
  EXPECT_LT(lost, 0.155);
}

// Newton's method converges in threads of any number of nodes (36 to 235 are drawn). The overhand is pulled at speeds
// at which no tick needs much work. With a proximal term that does not grow (contact_newton.hpp), the method cycles in
// one tick of every tenth pull, until the tick's work is used up. No pull of 620 did so: a share of at most 0.62 % (95
// % interval). With this share more than 7 of 120 pulls cycle less than once in a million draws; with a constant
// proximal term the test fails in 94 of 100 draws. Lost time is not asserted: with segments of 15 to 18 diameters (66
// and 55 nodes) a tight loop can snap, and then the guard shortens a substep (2 of 960 pulls).
TEST(Labour, IsNeverUsedUpByCycles) {
  constexpr int kPulls = 120, kMostCycles = 7;
  constexpr long kLittle = 4'000'000;
  Random random(607);
  long most = 0;
  int cycles = 0;
  for (int k = 0; k < kPulls; ++k) {
    const int nodes = 36 + static_cast<int>(random() % 200);
    int cut_short = 0;
    long work = 0;  // of the pull's worst tick
    const auto look = [&](const RodSimulation& sim) {
      cut_short += sim.rod().report().cut_short;
      work = std::max(work, sim.rod().report().work);
    };
    Tightening pull = pulled("suture-3-0-knot.toml", 0.03 + 0.12 * random.share(),
                             {"suture.nodes=" + std::to_string(nodes), "world.grippers_collide=false"}, look);
    for (int tick = 0; tick < 200; ++tick) {
      pull.tick(0.0);
      look(pull.sim());
    }
    cycles += cut_short > 0 || work >= kLittle;
    most = std::max(most, work);
  }
  RecordProperty("most", std::to_string(most));
  RecordProperty("cycles", cycles);
  EXPECT_LE(cycles, kMostCycles);
}

// With suture.accuracy = "fast" a tick has ten substeps, also when the budget runs out. With six substeps, square knots
// pulled to 5 N had up to 59 guard events, were then held with only 0.02 to 3.6 N, and lost as much time. Also with
// ten, `fast` loses time at these speeds, so some knots are held with less than 5 N; the mean force shows how well the
// simulation followed the pulls (4.83 to 4.90 N in nine draws of eight pulls). That the guard does nothing is no law:
// it did nothing in each of 72 drawn pulls, so its share is at most 5.1 % (95 % interval). With this share more than 7
// of 16 pulls have a guard event less than once in a million draws.
TEST(Labour, LeavesTenSubsteps) {
  constexpr int kPulls = 16, kMostGuarded = 7;
  double mean_N = 0.0;
  int guarded = 0;
  for (const double speed : speeds(kPulls, 0.15, 0.25, 605)) {
    int guard = 0, fewest = 100;
    const auto look = [&](const RodSimulation& sim) {
      guard += sim.rod().report().guard_events;
      fewest = std::min(fewest, sim.rod().report().substeps);
    };
    Tightening pull = pulled(kSquare, speed, {"suture.accuracy=\"fast\"", "suture.work_instructions=2995000"}, look);
    for (int k = 0; k < 500; ++k) {
      pull.tick(0.0);
      look(pull.sim());
    }
    guarded += guard > 0;
    EXPECT_EQ(fewest, 10) << speed;
    mean_N += Tightening::force(pull.sim()) / kPulls;
    RecordProperty("force_" + std::to_string(speed), std::to_string(Tightening::force(pull.sim())));
  }
  RecordProperty("mean_N", std::to_string(mean_N));
  RecordProperty("guarded", guarded);
  EXPECT_GT(mean_N, 3.5);
  EXPECT_LE(guarded, kMostGuarded);
}

/// A surgeon's knot drawn tight by two hands and held for 0.7 s.
Tightening held(double speed) {
  Tightening pull = pulled(kSurgeons, speed);
  for (int k = 0; k < 700; ++k) pull.tick(0.0);
  return pull;
}

// Contact work of a knot at rest, in instructions per tick; the small budget allows 4.7 million. The mean of 24 holds
// is 1.9 to 2.2 million in seven draws. If all pairs of segments at one place became contacts, it would be 3.1 million.
TEST(Hold, OfTwoThrowsAtRestIsCheap) {
  constexpr int kPulls = 24, kTicks = 200;
  double work = 0.0;
  for (const double speed : speeds(kPulls, 0.15, 0.25, 606)) {
    Tightening pull = held(speed);
    for (int k = 0; k < kTicks; ++k) {
      pull.tick(0.0);
      work += static_cast<double>(pull.sim().rod().report().work) / (kPulls * kTicks);
    }
  }
  RecordProperty("instructions", std::to_string(work));
  EXPECT_LT(work, 2.8e6);
}

/// Longest segment in a loaded contact, in diameters of the thread.
double longest_in_contact(const RodSimulation& sim) {
  double longest = 0.0;
  int loaded = 0;
  for (const auto& c : sim.rod().contact_set().contacts()) {
    if (dot(c.p, c.p) == 0.0) continue;
    ++loaded;
    for (const int k : {0, 2})
      longest = std::max(longest, sim.rod().state().mesh.rest[static_cast<std::size_t>(c.node[k])]);
  }
  EXPECT_GT(loaded, 10) << "the knot is tight";
  return longest / 3e-4;
}

// A loop of thread that touches the thread beside a tight knot with only 0.1 mN is meshed there as finely as the knot:
// with segments of one diameter in 58 of 60 pulls (89 to 99.6 %), of two diameters in the others. Without the rule for
// contacts at rest (refine.cpp), 16 of 40 pulls had segments of two to four diameters. The test draws 32 pulls and
// allows 8 coarse ones. It fails less than once in a million draws if 3 % of all pulls are coarse, and in 94 of 100
// draws if 40 % are.
TEST(FineZone, ReachesTheLoopThatTouches) {
  constexpr int kPulls = 32;
  int coarse = 0;
  for (const double speed : speeds(kPulls, 0.15, 0.25, 607)) coarse += longest_in_contact(held(speed).sim()) > 1.2;
  RecordProperty("coarse", coarse);
  EXPECT_LE(coarse, 8);
}

}  // namespace
}  // namespace ligature::test
