// The contact list of the rod contains only existing segments, whatever the velocities.

#include "firmware/physics/rod/contact/pair_search.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/unit/rod/rods.hpp"

namespace ligature::test {
namespace {

using namespace physics::rod;

/// 11 segments fill one block of eight lanes and three lanes of the next. The unused lanes must give no pairs, because
/// such pairs would cause out-of-range accesses. This holds even at the velocities of a thread that diverges within a
/// tick.
TEST(BroadPhase, NamesSegmentsOfTheThreadOnly) {
  for (const double speed : {0.0, 1e9, 1e22, 1e30, 1e300, std::numeric_limits<double>::infinity(), std::nan("")}) {
    Rod rod(unit_rod(), steps_of(1e-3), kBare, 12);
    State& state = rod.state();
    for (std::size_t i = 0; i < 12; ++i) state.x[i] = make(static_cast<double>(i) / 11.0, 0, 0);
    state.v[3] = make(0, speed, 0);
    BroadPhase broad;
    Motion motion;
    broad.reserve(12, 200);
    motion.reserve(12);
    motion.measure(state.v.data());
    std::vector<Candidate> pairs;
    std::vector<PairGroup> groups;
    pairs.reserve(200), groups.reserve(200);
    Work work;
    work.start(10'000'000);
    (void)broad.build(state, motion, {2e-3, 1e-3, 1e-4, 1e-3}, 10'000'000, work, {pairs, groups});
    for (const Candidate& pair : pairs) {
      EXPECT_LT(pair.b, 11) << speed;
      EXPECT_LE(pair.a + 2, pair.b) << speed;
    }
  }
}

}  // namespace
}  // namespace ligature::test
