#pragma once
// Moves: the steps of the operator's plan, and the data that a move gets when the operator looks at the thread.

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "sim_device/operator/hands.hpp"
#include "sim_device/operator/thread_view.hpp"

namespace ligature::sim {

/// Properties of thread and workplace; all lengths of a knot are multiples of these.
struct Workplace {
  Vec3 anchor_W = Vec3::Zero();  ///< where node 0 is held
  double length_m = 1.0;
  double diameter_m = 0.01;
  double clearance_m = 0.02;  ///< distance that the end keeps from strands that it passes
  double tension_N = 1.0;     ///< pull at which a knot counts as tight
  double speed_m_per_s = 0.1;
  double bend_length_m = 0.0;  ///< (EI / weight per length)^(1/3): shorter pieces stand by their own stiffness
};

/// All information that a move gets when the operator looks at the thread.
struct Look {
  const ThreadView& thread;
  const Sight& sight;
  const Workplace& place;
  std::array<MovingHand, 2>& hands;
  double in_move_s = 0.0;  ///< time since the move began

  /// Whether both the planned and the real position of the hand are within about `near_m` of its goal.
  [[nodiscard]] bool has_arrived(std::size_t hand, double near_m) const {
    return hands[hand].to_go_m() < near_m &&
           (sight.tool_W[hand] - hands[hand].p_W()).norm() < near_m + place.clearance_m;
  }
};

/// One step of a plan. act() is called each time the operator looks at the thread: it sets the hands' goals and returns
/// whether the move is done.
struct Move {
  std::string name;
  std::function<bool(const Look&)> act;
  double patience_s = 15.0;  ///< time limit; then the next move starts, whether this one is done or not
  /// Checked at the end of the move: did it succeed? If not, the operator lets go and starts again.
  std::function<bool(const Look&)> good{};
  bool ends_throw = false;  ///< a throw is complete: starting again resumes after this move
  /// When this move has ended, the operator counts the tied throws and plans the following moves
  bool then_plans = false;
};

using Moves = std::vector<Move>;
using Where = std::function<Vec3(const Look&)>;
using WhereAlong = std::function<double(const Look&)>;

/// Appends `more` to `moves`.
inline void append(Moves& moves, Moves more) {
  for (Move& m : more) moves.push_back(std::move(m));
}

}  // namespace ligature::sim
