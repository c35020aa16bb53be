// The contact list misses no pair, and its cost grows linearly with the thread's length.

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <set>
#include <utility>

#include "firmware/physics/closest.hpp"
#include "firmware/physics/rod/contact/pair_search.hpp"
#include "tests/support/random.hpp"
#include "tests/unit/rod/crumple.hpp"
#include "tests/unit/rod/rods.hpp"

namespace ligature::test {
namespace {

using namespace physics::rod;

constexpr double kDiameter = 3e-4;

// A random walk of n nodes, with segments of `segment` diameters, within `ball` diameters of the origin.
State walk(int n, double segment, double ball, double speed_m_per_s, Random& random) {
  const auto vector = [&] {
    const auto [x, y, z] = random.normals();
    return make(x, y, z);
  };
  State state;
  state.resize(n);
  Vec at{}, along = make(1, 0, 0);
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    state.mesh.s[i] = segment * kDiameter * static_cast<double>(i);
    state.x[i] = at;
    state.v[i] = speed_m_per_s * vector();
    along = along + 0.5 * vector() - (norm(at) / ball / ball / kDiameter / kDiameter) * at;
    along = (1.0 / norm(along)) * along;
    at = at + segment * kDiameter * along;
  }
  return state;
}

// All pairs that the contact list must contain, by testing each pair.
std::set<std::pair<int, int>> promised(const State& state, const Motion& motion, const Outlook& outlook) {
  std::set<std::pair<int, int>> all;
  const double d = outlook.diameter_m;
  for (std::size_t a = 0; a + 1 < state.x.size(); ++a) {
    for (std::size_t b = a + 2; b + 1 < state.x.size(); ++b) {
      const double arc = state.mesh.s[b] - state.mesh.s[a + 1];
      if (arc < BroadPhase::kLeastArc * d) continue;
      const double reach = arc < 0.5 * std::numbers::pi * d ? d * std::sin(arc / d) : d;
      const double limit = reach + outlook.skin_m + outlook.horizon_s * motion.rate(a, b);
      const double distance2 = physics::closest(state.x[a], state.x[a + 1], state.x[b], state.x[b + 1]).distance2;
      if (distance2 < limit * limit) all.emplace(static_cast<int>(a), static_cast<int>(b));
    }
  }
  return all;
}

struct Made {
  std::vector<Candidate> pairs;
  std::vector<PairGroup> groups;
  Motion motion;
  long spent = 0;
};

Made list_of(const State& state, const Outlook& outlook) {
  Made made;
  made.motion.reserve(state.nodes());
  made.motion.measure(state.v.data());
  made.motion.measure(state.v.data());
  BroadPhase broad;
  broad.reserve(state.nodes(), 1'000'000);
  broad.keep_impulses({});
  Work work;
  work.start(2'000'000'000);
  EXPECT_TRUE(broad.build(state, made.motion, outlook, work.left(), work, {made.pairs, made.groups}));
  made.spent = work.used();
  return made;
}

TEST(Growth, TheListHoldsEveryPairItPromises) {
  Random random(3);
  for (const int n : {5, 9, 17, 64, 65, 154, 300, 513}) {
    for (const double segment : {0.5, 1.0, 3.0}) {
      for (const double speed : {0.0, 0.3, 10.0}) {
        const State state = walk(n, segment, 6.0, speed, random);
        const Outlook outlook{kDiameter, 0.5 * kDiameter, 0.1 * kDiameter, speed > 1.0 ? 1.5e-4 : 1.2e-3};
        const Made made = list_of(state, outlook);
        std::set<std::pair<int, int>> listed;
        for (const auto& pair : made.pairs) {
          EXPECT_TRUE(listed.emplace(pair.a, pair.b).second) << "twice";
          const auto a = static_cast<std::size_t>(pair.a), b = static_cast<std::size_t>(pair.b);
          const double gap =
              std::sqrt(physics::closest(state.x[a], state.x[a + 1], state.x[b], state.x[b + 1]).distance2) -
              pair.reach_m;
          EXPECT_NEAR(pair.due, gap, 1e-12);
        }
        for (const auto& pair : promised(state, made.motion, outlook)) EXPECT_TRUE(listed.contains(pair)) << n;
      }
    }
  }
}

// The smooth curves of a pair may be nearer than its chords by the pair's bulge.
TEST(Growth, AListedGapIsABoundForSmoothCurves) {
  int bulges = 0;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Rod rod(Material{}, Numerics{}, Parts{}, 154);
    crumple_apart(rod, seed, 20.0, 0.0);
    const State& state = rod.state();
    for (const auto& pair : list_of(state, {kDiameter, 0.5 * kDiameter, 0.1 * kDiameter, 0.0}).pairs) {
      const auto a = static_cast<std::size_t>(pair.a), b = static_cast<std::size_t>(pair.b);
      const double distance2 = physics::closest(state.x[a], state.x[a + 1], state.x[b], state.x[b + 1]).distance2;
      EXPECT_NEAR(pair.due, std::sqrt(distance2) - pair.reach_m - pair.bulge_m, 1e-12);
      bulges += pair.bulge_m > 0.1 * kDiameter;
    }
  }
  EXPECT_GT(bulges, 50);
}

TEST(Growth, AGroupKnowsTheFastestOfItsPairs) {
  Random random(4);
  State state = walk(203, 1.0, 8.0, 1.0, random);
  Made made = list_of(state, {kDiameter, 0.5 * kDiameter, 0.1 * kDiameter, 1e-3});
  made.motion.advance(1e-4);
  std::int32_t next = 0;
  for (const auto& group : made.groups) {
    EXPECT_EQ(group.first, next);
    next = group.last;
    const auto p = static_cast<std::size_t>(group.p), q = static_cast<std::size_t>(group.q);
    for (std::int32_t k = group.first; k < group.last; ++k) {
      const auto a = static_cast<std::size_t>(made.pairs[static_cast<std::size_t>(k)].a);
      const auto b = static_cast<std::size_t>(made.pairs[static_cast<std::size_t>(k)].b);
      EXPECT_LE(made.motion.rate(a, b), made.motion.rate_of_blocks(p, q) + 1e-12);
      EXPECT_LE(made.motion.gone(a, b), made.motion.gone_of_blocks(p, q) + 1e-15);
    }
  }
  EXPECT_EQ(next, static_cast<std::int32_t>(made.pairs.size()));
}

// A loose coil and a ball (a random walk), both moving, with 250 and 2000 nodes. In the ball the cost per pair grows by
// an eighth with each doubling of the nodes, because more bounding boxes overlap without containing a close pair. If
// all pairs were tested, the cost per node would be 8 times as large with 2000 nodes as with 250. The mean over six
// walks reduces the scatter.
TEST(Growth, AListCostsByTheNodeAndByThePair) {
  Random random(5);
  const Outlook outlook{kDiameter, 0.5 * kDiameter, 0.1 * kDiameter, 1.2e-3};
  for (const double ball : {1e9, 20.0}) {
    const auto each = [&](int n, double radius) {
      double spent = 0.0, found = 0.0;
      for (int k = 0; k < 6; ++k) {
        const Made made = list_of(walk(n, 1.0, radius, 0.02, random), outlook);
        spent += static_cast<double>(made.spent);
        found += static_cast<double>(made.pairs.size() + static_cast<std::size_t>(n));
      }
      return spent / found;
    };
    const double small = each(250, ball), large = each(2000, 2.0 * ball);
    EXPECT_LT(large, 1.75 * small) << ball;
  }
}

// A thread without a knot, drawn along at 1 m/s. With 1500 nodes its segments are two thirds of a diameter long, the
// worst case for pairs of neighbours along the thread.
TEST(Growth, ATickOfADrawnThreadCostsTheSamePerNode) {
  for (const int nodes : {512, 1024, 1500, 2000}) {
    Rod rod(Material{}, Numerics{}, Parts{true, true, true, false, false}, nodes);
    std::array<Vec, kMaxHolds> goals{};
    goals[0] = rod.state().x.front(), goals[1] = rod.state().x.back();
    rod.grip(0, 500.0, 0.5, goals[0]);
    rod.grip(nodes - 1, 500.0, 0.5, goals[1]);
    long work = 0;
    for (int k = 0; k < 20; ++k) {
      goals[0] += make(1e-3, 0, 0), goals[1] += make(1e-3, 0, 0);
      rod.tick(goals);
      work += rod.report().work;
      EXPECT_EQ(rod.report().time_lost, 0.0) << nodes << ' ' << k;
      EXPECT_EQ(rod.report().contacts, 0) << nodes;
    }
    EXPECT_LT(work / 20, 1400L * nodes);
  }
}

// When the budget is too small for a new list, the contacts must keep their impulses for the solver's start. Without
// these impulses a held surgeon's knot moved at 10 m/s in that substep and overlapped by 0.8 d.
TEST(Growth, AListThatCannotBeAffordedKeepsTheImpulses) {
  Random random(5);
  const State state = walk(300, 1.0, 8.0, 0.0, random);
  const Outlook outlook{kDiameter, 0.5 * kDiameter, 0.1 * kDiameter, 0.0};
  Made made = list_of(state, outlook);
  ASSERT_GT(made.pairs.size(), 100U);
  for (auto& pair : made.pairs) pair.impulse = make(1.0 + pair.a, 1.0 + pair.b, 0.0), pair.stuck = 1;
  const std::size_t whole = made.pairs.size();
  BroadPhase broad;
  broad.reserve(state.nodes(), 1'000'000);
  const PairList list{made.pairs, made.groups};
  Work work;
  const auto build = [&](long allowance) {
    work.start(2'000'000'000);
    broad.keep_impulses(made.pairs);
    const bool built = broad.build(state, made.motion, outlook, allowance, work, list);
    if (!built) broad.put_back(list);
    return built;
  };
  // With each of these allowances the search ends at another place
  for (int k = 0; k < 40; ++k)
    EXPECT_FALSE(build(std::max(BroadPhase::least_cost(state.nodes()), k * made.spent / 40)));
  EXPECT_TRUE(build(2 * made.spent));
  ASSERT_EQ(made.pairs.size(), whole);
  for (const auto& pair : made.pairs) {
    EXPECT_EQ(pair.impulse[0], 1.0 + pair.a) << pair.a << ' ' << pair.b;
    EXPECT_EQ(pair.stuck, 1) << pair.a << ' ' << pair.b;
  }
}

}  // namespace
}  // namespace ligature::test
