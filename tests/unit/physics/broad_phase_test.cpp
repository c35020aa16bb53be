// Every broad phase reports exactly the pairs that testing all pairs finds: for random walks, coils, piles, lines,
// points.
#include <gtest/gtest.h>

#include "firmware/physics/closest.hpp"
#include "firmware/physics/paper/bvh.hpp"
#include "firmware/physics/paper/sweep_and_prune.hpp"
#include "tests/unit/physics/random_states.hpp"

namespace ligature::physics {
namespace {

using test::V;

/// Test shape number k with n nodes: one of five regular or degenerate kinds, else a random walk.
Lane3 shape(int k, int n, test::Random& random) {
  Lane3 p(n);
  V at = random.vector(3.0);
  for (int i = 0; i < n; ++i) {
    switch (k % 8) {
      case 0:
        break;  // all in one point
      case 1:
        at = {0.1 * i, 0.0, 0.0};
        break;  // straight, exactly regular
      case 2:
        at = {0.1 * (i % 2), 0.0, 0.0};
        break;  // folded back and forth
      case 3:
        at = {0.3 * std::cos(0.4 * i), 0.3 * std::sin(0.4 * i), 0.002 * i};
        break;  // coil
      case 4:
        at = random.vector(0.3);
        break;  // long segments in a heap
      default:
        at = at + random.vector(0.12);
        break;  // random walk
    }
    p.put(i, at);
  }
  return p;
}

TEST(BroadPhase, SweepAndTreeReportThePairsOfBruteForceInTenThousandShapes) {
  test::Random random(5);
  std::size_t found = 0;
  for (const int n : {2, 3, 8, 21, 50, 101}) {
    SegmentSpheres spheres(n - 1);
    Sweep sweep(n - 1);
    SphereTree tree(n - 1);
    PairList brute, swept, explored;
    for (PairList* list : {&brute, &swept, &explored}) list->pairs.reserve(static_cast<std::size_t>(n * n));
    for (int k = 0; k < 1700; ++k) {
      spheres.update(shape(k, n, random));
      const double reach = k % 3 == 0 ? 0.1 : random.in(0.0, 0.3);
      const int skip = 2 + k % 3;
      find_pairs_brute(spheres, reach, skip, brute);
      sweep.find_pairs(spheres, reach, skip, swept);
      tree.find_pairs(spheres, reach, skip, explored);
      ASSERT_EQ(brute.pairs, swept.pairs) << "sweep, shape " << k << ", " << n << " nodes";
      ASSERT_EQ(brute.pairs, explored.pairs) << "tree, shape " << k << ", " << n << " nodes";
      found += brute.pairs.size();
    }
  }
  EXPECT_GT(found, 100000U);
}

// Brute force itself, checked by the distances of all pairs: no touching pair is missing.
TEST(BroadPhase, BruteForceMissesNoTouchingPair) {
  test::Random random(6);
  SegmentSpheres spheres(40);
  PairList pairs;
  pairs.pairs.reserve(2000);
  for (int k = 0; k < 500; ++k) {
    const Lane3 p = shape(k, 41, random);
    spheres.update(p);
    find_pairs_brute(spheres, 0.1, 2, pairs);
    for (int i = 0; i < 40; ++i)
      for (int j = i + 2; j < 40; ++j)
        if (root(closest(p.at(i), p.at(i + 1), p.at(j), p.at(j + 1)).distance2) < 0.1 - 1e-12) {
          EXPECT_TRUE(std::binary_search(pairs.pairs.begin(), pairs.pairs.end(), SegmentPair{i, j}));
        }
  }
}

TEST(BroadPhase, AFullListSaysSo) {
  SegmentSpheres spheres(40);
  PairList pairs;
  pairs.pairs.reserve(5);
  spheres.update(Lane3(41));
  find_pairs_brute(spheres, 0.1, 2, pairs);
  EXPECT_TRUE(pairs.overflow);
  EXPECT_EQ(pairs.pairs.size(), 5U);
}

// The distance of densely sampled pairs of points is an upper bound; the closest points must not be farther apart.
TEST(Closest, AreNoFartherThanAnySampledPair) {
  test::Random random(12);
  auto states = test::degenerate_nodes(4, 13);
  for (int k = 0; k < 2000; ++k) states.push_back(random.nodes(4));
  for (const auto& s : states) {
    const auto c = closest(s.p[0], s.p[1], s.p[2], s.p[3]);
    ASSERT_TRUE(c.s >= 0 && c.s <= 1 && c.t >= 0 && c.t <= 1);
    for (int i = 0; i <= 10; ++i)
      for (int j = 0; j <= 10; ++j) {
        const V a = s.p[0] + (0.1 * i) * (s.p[1] - s.p[0]), b = s.p[2] + (0.1 * j) * (s.p[3] - s.p[2]);
        ASSERT_LE(root(c.distance2), norm(a - b) + 1e-9);
      }
    const V apart = s.p[2] + c.t * (s.p[3] - s.p[2]) - (s.p[0] + c.s * (s.p[1] - s.p[0]));
    ASSERT_NEAR(norm(apart - c.between), 0.0, 1e-12);
    ASSERT_NEAR(norm(c.between), root(c.distance2), 1e-12);
  }
}

}  // namespace
}  // namespace ligature::physics
