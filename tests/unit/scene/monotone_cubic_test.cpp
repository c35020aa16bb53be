#include "protocol/scene/monotone_cubic.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/random.hpp"

namespace ligature::scene {
namespace {

/// Keys that move along x only.
std::vector<GripKey> along_x(const std::vector<std::array<double, 2>>& t_and_x) {
  std::vector<GripKey> keys;
  for (const auto& [t_s, x_m] : t_and_x) keys.push_back({t_s, {x_m, 0, 0}, true, {x_m, 0, 0}});
  pass_through(keys);
  return keys;
}

double x_at(const std::vector<GripKey>& keys, double t_s) { return sample(keys, t_s).p_W_m[0]; }

TEST(MonotoneCubic, VelocitiesAreTheWeightedHarmonicMeans) {
  // Before and after key 1: 1 s at a mean of 1 m/s, 2 s at 4 m/s. Weights 1 + 2 * 2 = 5 and 2 * 1 + 2 = 4 give (5 + 4)
  // / (5 / 1 + 4 / 4) = 1.5 m/s.
  const auto keys = along_x({{0, 0}, {1, 1}, {3, 9}, {4, 9}, {5, 8}, {6, 9}});
  EXPECT_DOUBLE_EQ(keys[1].v_W_m_per_s[0], 1.5);
  EXPECT_DOUBLE_EQ(keys[1].turn_deg_per_s[0], 1.5);
  EXPECT_EQ(keys[2].v_W_m_per_s[0], 0.0);  // the next segment is a rest
  EXPECT_EQ(keys[4].v_W_m_per_s[0], 0.0);  // the position has an extremum here
  EXPECT_EQ(keys[1].v_W_m_per_s[1], 0.0);
}

TEST(MonotoneCubic, SteadyMotionStaysSteadyAndBeginsAndEndsAtRest) {
  const auto keys = along_x({{0, 0}, {1, 2}, {2, 4}, {4, 8}, {5, 10}});
  for (double t_s = 1.0; t_s <= 4.0; t_s += 0.1) EXPECT_NEAR(x_at(keys, t_s), 2.0 * t_s, 1e-12);
  EXPECT_EQ(keys.front().v_W_m_per_s, (Vec{}));
  EXPECT_EQ(keys.back().v_W_m_per_s, (Vec{}));
  // From rest to v = 2 over T = 1: p(u) = 2 s(u) - u^2 (1 - u) 2 = 4 u^2 - 2 u^3
  EXPECT_DOUBLE_EQ(x_at(keys, 0.5), 4.0 * 0.25 - 2.0 * 0.125);
}

TEST(MonotoneCubic, OfTwoKeysIsSmoothstep) {
  const auto keys = along_x({{1, 0}, {3, 2}});
  EXPECT_DOUBLE_EQ(x_at(keys, 1.5), 2.0 * (3.0 / 16.0 - 2.0 / 64.0));
}

/// 1000 keys with random times and positions: the curve passes every key, never leaves the range between two keys, and
/// its velocity is continuous.
TEST(MonotoneCubic, PassesKeysStaysBetweenThemAndHasNoStepOfVelocity) {
  test::Random random(7);
  for (const double back : {0.0, 1.0}) {  // increasing only, and back and forth
    std::vector<std::array<double, 2>> path{{0.0, 0.0}};
    while (path.size() < 500) {
      const double wait_s = random.in(0.01, 1.0), way_m = random.in(-back, 1.0);
      path.push_back({path.back()[0] + wait_s, path.back()[1] + way_m});
    }
    const auto keys = along_x(path);
    for (std::size_t k = 1; k < path.size(); ++k) {
      const auto [t0, x0] = path[k - 1];
      const auto [t1, x1] = path[k];
      EXPECT_NEAR(x_at(keys, t1), x1, 1e-12);
      const double before = sample(keys, t1 - 1e-9).v_W_m_per_s[0], after = sample(keys, t1 + 1e-9).v_W_m_per_s[0];
      EXPECT_NEAR(before, after, 1e-4) << t1;
      double last = x0;
      for (double u = 0.05; u < 1.0; u += 0.05) {
        const double x = x_at(keys, t0 + u * (t1 - t0));
        EXPECT_GE((x - last) * (x1 - x0), -1e-12) << "key " << k << ", u " << u;
        last = x;
      }
    }
  }
}

}  // namespace
}  // namespace ligature::scene
