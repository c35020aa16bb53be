// The guard shortens substeps in which strands could pass through each other: which motions it shortens and which not.

#include <gtest/gtest.h>

#include "firmware/physics/closest.hpp"
#include "firmware/physics/rod/contact/contact_set.hpp"
#include "tests/support/random.hpp"

namespace ligature::test {
namespace {

using namespace physics::rod;

constexpr double kDiameter_m = 3e-4, kSubstep_s = 1e-3 / 24;

// Segments 0 and 2 of a thread of four nodes, one diameter apart, and the share of a substep that the guard allows.
struct Two {
  State state;
  Two() {
    state.resize(4);
    state.x = {make(-kDiameter_m, 0, 0), make(kDiameter_m, 0, 0), make(0, -kDiameter_m, kDiameter_m),
               make(0, kDiameter_m, kDiameter_m)};
  }
  double share() {
    Motion motion;
    motion.reserve(4);
    motion.measure(state.v.data());
    Candidate pair;
    pair.a = 0, pair.b = 2, pair.reach_m = kDiameter_m;
    pair.due = std::sqrt(physics::closest(state.x[0], state.x[1], state.x[2], state.x[3]).distance2) - pair.reach_m;
    ContactSet contacts;
    contacts.pairs = {pair};
    return contacts.safe_fraction_of_pairs(motion, state, kSubstep_s);
  }
};

// For a free end that flies past a strand or away from it, even at 26 m/s, the substep must not be shortened. Only
// towards the strand it is shortened to 0.9 of the distance.
TEST(Guard, LetsPassWhatFliesByOrAway) {
  for (const Vec u : {make(26, 0, 0), make(0, 26, 0), make(20, 5, 14), make(0, 0, 26), make(18, 18, -2)}) {
    Two two;
    two.state.v[2] = two.state.v[3] = u;
    EXPECT_EQ(two.share(), 1.0) << u[0] << ' ' << u[1] << ' ' << u[2];
  }
  Two two;
  two.state.v[2] = two.state.v[3] = make(0, 0, -26);
  EXPECT_NEAR(two.share(), 0.9 * kDiameter_m / (26 * kSubstep_s), 1e-9);
}

TEST(Guard, LetsNothingThrough) {
  test::Random random(11);
  const auto normal = [&] { return random.normal(); };
  const auto vec = [&](double size) { return size * Vec{{normal(), normal(), normal(), 0.0}}; };
  int free = 0, held = 0;
  for (int round = 0; round < 4000; ++round) {
    Two two;
    for (auto& x : two.state.x) x = vec(2.0 * kDiameter_m);
    for (auto& v : two.state.v) v = vec(15.0);
    const auto distance = [&](double t_s) {
      const auto at = [&](std::size_t i) { return two.state.x[i] + t_s * two.state.v[i]; };
      return std::sqrt(physics::closest(at(0), at(1), at(2), at(3)).distance2);
    };
    const double share = two.share(), begun = distance(0.0);
    (share == 1.0 ? free : held)++;
    for (int k = 1; k <= 40; ++k)
      ASSERT_GT(distance(share * kSubstep_s * k / 40), 0.0999 * begun) << round << ' ' << share << ' ' << k;
  }
  EXPECT_GT(free, 500);
  EXPECT_GT(held, 500);
}

}  // namespace
}  // namespace ligature::test
