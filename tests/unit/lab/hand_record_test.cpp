#include "host/lab/tie/hand_record.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sim_device/script_hand.hpp"

namespace ligature::lab {
namespace {

sim::WorkspaceMap map() {
  scene::Hands hands;
  hands.workspace_scale = 1.0;
  return sim::WorkspaceMap(hands);
}

/// Motion of the hands at time t_s: the left one on a helix, with jaws that close and open; the right one out of reach
/// and back.
std::array<sim::HandWish, 2> wish_at(double t_s) {
  std::array<sim::HandWish, 2> wish;
  wish[0].p_W = {0.03 * std::cos(2.0 * t_s), 0.03 * std::sin(2.0 * t_s), 0.01 * t_s};
  wish[0].grip = t_s >= 1.0 && t_s < 3.5;
  wish[1].p_W = {0.0, 0.0, -0.4 * std::sin(M_PI * t_s / 5.0)};
  return wish;
}

scene::GripperScript recorded(double tolerance_m) {
  HandRecord record(map());
  for (int tick = 0; tick <= 5000; ++tick) record.add(1e-3 * tick, wish_at(1e-3 * tick));
  return record.script(tolerance_m);
}

TEST(HandRecord, FollowsTheHandsWithinTheToleranceWithFewKeys) {
  std::size_t keys_before = 100'000;
  for (const double tolerance_m : {2e-5, 1e-4, 1e-3}) {
    const auto script = recorded(tolerance_m);
    for (int tick = 0; tick <= 5000; ++tick) {
      const auto pose = scene::sample(script.keys[0], 1e-3 * tick);
      const auto wish = wish_at(1e-3 * tick)[0];
      EXPECT_LT((sim::Vec3(pose.p_W_m.data()) - wish.p_W).norm(), tolerance_m + 1e-5) << tick;
      EXPECT_EQ(pose.grip, wish.grip) << tick;
    }
    EXPECT_LT(script.keys[0].size(), keys_before);
    keys_before = script.keys[0].size();
  }
  EXPECT_LT(keys_before, 60u);
}

/// Rounding must not move a key out of reach, wherever the hand is (this happened in a square knot's script).
TEST(HandRecord, EveryKeyCanBePlayed) {
  HandRecord record(map());
  for (int tick = 0; tick <= 20000; ++tick) {
    std::array<sim::HandWish, 2> wish;
    const double a = 0.0917 * tick, b = 0.0231 * tick, r = 0.1 + 0.15 * std::sin(0.0013 * tick);
    for (auto& w : wish) w.p_W = r * sim::Vec3(std::cos(a) * std::cos(b), std::sin(a) * std::cos(b), std::sin(b));
    record.add(1e-3 * tick, wish);
  }
  for (const auto& key : record.script(1e-9).keys[0]) EXPECT_EQ(sim::objection_to(key, map()), "");
}

TEST(HandRecord, StaysWithinTheArmsReach) {
  const auto script = recorded(1e-4);
  const auto& keys = script.keys[1];
  double lowest_m = 0.0;
  for (const auto& key : keys) {
    EXPECT_EQ(sim::objection_to(key, map()), "");
    lowest_m = std::min(lowest_m, key.p_W_m[2]);
  }
  EXPECT_LT(lowest_m, -0.05);  // the path is recorded down to the limit of the reach
  EXPECT_GT(lowest_m, -0.4);
}

}  // namespace
}  // namespace ligature::lab
