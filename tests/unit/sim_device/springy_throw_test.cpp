// Throws in a thread that stands by itself.

#include "sim_device/operator/springy_throw.hpp"

#include <gtest/gtest.h>

#include "tests/unit/sim_device/tied.hpp"

namespace ligature::sim {
namespace {

/// Where drawing a thread straight sends the right hand at first sight; the places of the thread are given.
Vec3 hand_sent(const std::vector<Vec3>& line) {
  const Workplace place{line.front(), 0.3, 3e-4, 0.0105, 1.1, 0.17};
  std::array<MovingHand, 2> hands{MovingHand(0.01), MovingHand(0.01)};
  for (MovingHand& h : hands) h.rest_at({0.1, -0.1, 0.2}, place.speed_m_per_s);
  ThreadView thread;
  thread.look(line);
  Sight sight;
  sight.thread_W = line;
  sight.tool_W = {hands[0].p_W(), hands[1].p_W()};
  const Look look{thread, sight, place, hands};
  for (Move& m : draw_straight())
    if (!m.act(look)) break;
  return hands[kRightHand].goal_W;
}

TEST(SpringyThrow, AThreadThatHangsStraightIsNotDrawnStraight) {
  EXPECT_TRUE(hand_sent({{0, 0, 0.35}, {0, 0, 0.05}}).isApprox(Vec3(0.1, -0.1, 0.2)));
  const Vec3 bent = hand_sent({{0, 0, 0.35}, {0.15, 0, 0.35}, {0.15, 0, 0.2}});
  EXPECT_LT((bent - Vec3(0.15, 0, 0.2)).norm(), 0.02) << "to the end";
}

}  // namespace
}  // namespace ligature::sim
