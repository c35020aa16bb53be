// Steps (moves) of the simulated operator with a thread so stiff that it stands by itself.

#include "sim_device/operator/springy_throw.hpp"

#include <gtest/gtest.h>

#include "sim_device/operator/primitives.hpp"
#include "tests/unit/sim_device/tied.hpp"

namespace ligature::sim {
namespace {

/// What the moves that straighten the thread do when it has these node positions.
struct Straightened {
  Vec3 hand_sent;      ///< the first position to which the right hand is sent
  int judged_bad = 0;  ///< moves that are done at once, and are judged to have failed
};

Straightened straightened(const std::vector<Vec3>& line) {
  const Workplace place{line.front(), 0.3, 3e-4, 0.0105, 1.1, 0.17};
  std::array<MovingHand, 2> hands{MovingHand(0.01), MovingHand(0.01)};
  for (MovingHand& h : hands) h.rest_at({0.1, -0.1, 0.2}, place.speed_m_per_s);
  ThreadView thread;
  thread.look(line);
  Sight sight;
  sight.thread_W = line;
  sight.tool_W = {hands[0].p_W(), hands[1].p_W()};
  const Look look{thread, sight, place, hands};
  Straightened result;
  for (Move& m : draw_straight()) {
    if (!m.act(look)) break;
    result.judged_bad += m.good && !m.good(look);
  }
  result.hand_sent = hands[kRightHand].goal_W;
  return result;
}

TEST(SpringyThrow, AThreadThatHangsStraightIsNotDrawnStraight) {
  const Straightened straight = straightened({{0, 0, 0.35}, {0, 0, 0.05}});
  EXPECT_TRUE(straight.hand_sent.isApprox(Vec3(0.1, -0.1, 0.2)));
  EXPECT_EQ(straight.judged_bad, 0) << "each would use up one of the operator's three new beginnings";
  const Vec3 bent = straightened({{0, 0, 0.35}, {0.15, 0, 0.35}, {0.15, 0, 0.2}}).hand_sent;
  EXPECT_LT((bent - Vec3(0.15, 0, 0.2)).norm(), 0.02) << "to the end";
}

/// Jaws that close on nothing open and try again; an operator that gives up holds nothing.
TEST(Take, LooksWhatItHoldsAndTriesAgain) {
  const std::vector<Vec3> line{{0, 0, 0.35}, {0, 0, 0.05}};
  const Workplace place{line.front(), 0.3, 3e-4, 0.0105, 1.1, 0.17};
  for (const int failures : {0, 1, 2, 1000}) {
    std::array<MovingHand, 2> hands{MovingHand(0.01), MovingHand(0.01)};
    for (MovingHand& h : hands) h.rest_at({0.02, -0.03, 0.2}, place.speed_m_per_s);
    ThreadView thread;
    thread.look(line);
    Move move = take(kRightHand, [](const Look&) { return 0.15; });
    int closed = 0;
    bool done = false, was = false;
    double in_move_s = 0.0;
    for (; in_move_s < move.patience_s && !done; in_move_s += 0.01) {
      Sight sight;
      sight.thread_W = line;
      sight.tool_W = {hands[0].p_W(), hands[1].p_W()};
      sight.holds[kRightHand] = closed > failures;
      done = move.act({thread, sight, place, hands, in_move_s});
      if (hands[kRightHand].grip && !was) {
        ++closed;
        EXPECT_LT((hands[kRightHand].p_W() - Vec3(0, 0, 0.2)).norm(), 2.0 * place.diameter_m)
            << "looks before it closes";
      }
      was = hands[kRightHand].grip;
      for (MovingHand& h : hands) h.tick();
    }
    Sight sight;
    sight.holds[kRightHand] = closed > failures;
    EXPECT_EQ(done, failures < 1000);
    EXPECT_EQ(move.good({thread, sight, place, hands, in_move_s}), failures < 1000);
    EXPECT_TRUE(!done || closed == failures + 1) << closed;
  }
}

/// The thread's end is below the reach of the arm: the thread is gripped higher up, where the arm reaches.
TEST(Take, GoesUpAlongAThreadWhoseEndIsOutOfReach) {
  const std::vector<Vec3> line{{0, 0, 0.35}, {0, 0, 0.05}};
  const Workplace place{line.front(), 0.3, 3e-4, 0.0105, 1.1, 0.17};
  constexpr double kLowest_m = 0.059;
  std::array<MovingHand, 2> hands{MovingHand(0.01), MovingHand(0.01)};
  for (MovingHand& h : hands) h.rest_at({0.02, -0.03, 0.1}, place.speed_m_per_s);
  ThreadView thread;
  thread.look(line);
  Move move = take(kRightHand, [](const Look& look) { return look.thread.length_m(); });
  Vec3 tool = hands[kRightHand].p_W();
  bool done = false;
  for (double t_s = 0.0; t_s < move.patience_s && !done; t_s += 0.01) {
    for (MovingHand& h : hands) h.tick();
    tool = hands[kRightHand].p_W();
    tool.z() = std::max(tool.z(), kLowest_m);
    Sight sight;
    sight.thread_W = line;
    sight.tool_W = {hands[0].p_W(), tool};
    done = move.act({thread, sight, place, hands, t_s});
  }
  EXPECT_TRUE(done);
  EXPECT_LT(std::hypot(tool.x(), tool.y()), 1.5 * place.diameter_m);
  EXPECT_LT(tool.z(), kLowest_m + 0.005) << "no further up than it must";
}

}  // namespace
}  // namespace ligature::sim
