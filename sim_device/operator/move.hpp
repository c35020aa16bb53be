#pragma once
// What a move of the operator's hands can see and use.

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "sim_device/operator/hands.hpp"
#include "sim_device/operator/thread_view.hpp"

namespace ligature::sim {

/// The thread's world in the operator's measure. All lengths of a knot are multiples of these.
struct Workplace {
  Vec3 anchor_W = Vec3::Zero();  ///< where node 0 is held
  double length_m = 1.0;
  double diameter_m = 0.01;
  double clearance_m = 0.02;  ///< how far an end keeps from strands that it passes
  double tension_N = 1.0;     ///< a knot is tight at this pull
  double speed_m_per_s = 0.1;
  double bend_length_m = 0.0;  ///< (EI / weight per length)^(1/3): a shorter piece stands by itself
};

/// Everything a move decides from, at one look.
struct Look {
  const ThreadView& thread;
  const Sight& sight;
  const Workplace& place;
  std::array<MovingHand, 2>& hands;
  double in_move_s = 0.0;  ///< since the move began

  /// The hand is where it was sent, to within `near_m`, in intention and in fact.
  [[nodiscard]] bool has_arrived(std::size_t hand, double near_m) const {
    return hands[hand].to_go_m() < near_m &&
           (sight.tool_W[hand] - hands[hand].p_W()).norm() < near_m + place.clearance_m;
  }
};

/// One step of a plan: looks, sends the hands, and says when it is done.
struct Move {
  std::string name;
  std::function<bool(const Look&)> act;
  double patience_s = 15.0;  ///< after that the operator goes on, done or not
  /// Asked when the move has ended: did it do what it was for? If not, the operator lets go and begins again.
  std::function<bool(const Look&)> good{};
  bool ends_throw = false;  ///< what is tied up to here stays: beginning again begins behind it
  bool then_plans = false;  ///< what comes next is planned when this has ended
};

using Moves = std::vector<Move>;
using Where = std::function<Vec3(const Look&)>;
using WhereAlong = std::function<double(const Look&)>;

/// `more` behind `moves`.
inline void append(Moves& moves, Moves more) {
  for (Move& m : more) moves.push_back(std::move(m));
}

}  // namespace ligature::sim
