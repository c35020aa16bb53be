// Throws for which the operator winds the end round the standing part (the thread above the left hand): the knot that
// the hand's path alone makes, and knots of two throws in a simulated thread.

#include "sim_device/operator/wound_throw.hpp"

#include <gtest/gtest.h>

#include "tests/unit/sim_device/tied.hpp"

namespace ligature::sim {
namespace {

using test::tied;

using Line = std::vector<Vec3>;

std::string knot_of(std::span<const Vec3> line) {
  const auto k = test::recognised(line);
  return k.type + " " + k.handedness;
}

/// An ideal thread without weight and stiffness and of any length. It runs straight from the anchor to the left hand,
/// down to where the right hand took the end, and then along the path that the right hand has moved on.
class Trail {
 public:
  Line after(const Throw& t) {
    hands_[kLeftHand].rest_at({-1.0, -1.0, -2.0}, place_.speed_m_per_s);
    hands_[kRightHand].rest_at({1.0, -1.0, -2.0}, place_.speed_m_per_s);
    bool drawn = false;
    for (Move& m : wound_throw(t, std::make_shared<Site>(Site{0.0, 1.0}))) {
      if (drawn && m.name != "draw") break;  // the operator's steps after "draw" need a simulated thread
      drawn = m.name == "draw";
      run(m);
    }
    return line();
  }

 private:
  [[nodiscard]] Line line() const {
    Line line{place_.anchor_W};
    if (hands_[kLeftHand].grip) line.push_back(hands_[kLeftHand].p_W());
    if (path_.empty()) line.push_back(line.back() + Vec3(0.0, 0.0, -4.0));
    line.insert(line.end(), path_.begin(), path_.end());
    return line;
  }

  void run(Move& m) {
    for (double t_s = 0.0; t_s < m.patience_s; t_s += 0.01) {
      const Line now = line();
      ThreadView thread;
      thread.look(now);
      Sight sight;
      sight.thread_W = now;
      for (std::size_t h = 0; h < 2; ++h) sight.tool_W[h] = hands_[h].p_W();
      const Look look{thread, sight, place_, hands_, t_s};
      if (m.act(look)) {
        EXPECT_TRUE(!m.good || m.good(look)) << m.name;
        return;
      }
      for (MovingHand& h : hands_) h.tick();
      if (hands_[kRightHand].grip) path_.push_back(hands_[kRightHand].p_W());
    }
  }

  Workplace place_{Vec3::Zero(), 5.0, 0.1, 0.25, 40.0, 0.7};
  std::array<MovingHand, 2> hands_{MovingHand(0.01), MovingHand(0.01)};
  Line path_;
};

TEST(WoundThrow, TheHandsPathAloneIsTheThrow) {
  EXPECT_EQ(knot_of(Trail().after({1, false, 1})), "3_1 right");
  EXPECT_EQ(knot_of(Trail().after({-1, false, 1})), "3_1 left");
  EXPECT_EQ(knot_of(Trail().after({1, false, 2})), "5_1 right");
  EXPECT_EQ(knot_of(Trail().after({-1, false, 2})), "5_1 left");
}

TEST(WoundThrow, ThrowsInARowAreTheNamedKnots) {
  for (const char* name : {"square", "granny", "surgeon"}) {
    const auto knot = knot_named(name);
    ASSERT_TRUE(knot) << name;
    Line row;
    for (const Throw& t : knot->throws) {
      const Vec3 from = row.empty() ? Vec3::Zero() : Vec3(row.back() + Vec3(10.0, 0.0, 0.0));
      for (const Vec3& p : Trail().after(t)) row.push_back(from + p);
    }
    EXPECT_EQ(knot_of(row), std::string(knot->type) + " " + std::string(knot->handedness)) << name;
  }
}

/// The hands move the simulated thread directly. The knot is checked five seconds after they let go.
TEST(WoundThrow, TiesKnotsOfTwoThrows) {
  EXPECT_EQ(tied("paper.toml", "square", 4), "3_1#3_1 amphichiral");
  EXPECT_EQ(tied("paper.toml", "granny", 104), "3_1#3_1 left");
  EXPECT_EQ(tied("paper-long.toml", "surgeon", 4), "3_1#5_1 mixed");
}

TEST(WoundThrow, TiesALimpThreadWhoseBightHangsStraightDown) {
  EXPECT_EQ(tied("paper.toml", "square", 1, {"suture.model=\"paper-1\""}), "3_1#3_1 amphichiral");
}

TEST(WoundThrow, RefusesAThreadTooShortForTheKnot) {
  EXPECT_EQ(tied("paper.toml", "surgeon", 1),
            "suture.length_m: found 5, allowed 6 or more for a surgeon knot in a thread this thick");
}

}  // namespace
}  // namespace ligature::sim
