#pragma once
// Adapts the rod's work to the computing time that it has: each tick gets a plan, made from the plan of the last tick
// and from what happened in it.

#include <algorithm>

#include "firmware/physics/members.hpp"
#include "firmware/physics/rod/model/material.hpp"
#include "firmware/physics/rod/tick_report.hpp"

namespace ligature::physics::rod {

/// What happens to the thread in a tick, and what came of the last one.
struct Situation {
  double hand_m_per_s = 0.0;   ///< speed of the fastest hold
  double apart_m_per_s = 0.0;  ///< largest relative speed of two holds; of a single hold: its speed
  bool alone = false;          ///< at most one hold, and nothing that holds or touches the thread moves (glossary)
  bool released = false;       ///< a hold was released since the last tick
  bool waits = false;          ///< a substep that the last tick began is not solved yet
  double node_m_per_s = 0.0;   ///< speed of the fastest node
  int nodes = 0;
};

/// Rules of one tick. They depend on nothing but the arguments of plan(), so each can be tested without a thread.
struct Plan {
  int substeps = 0;
  long budget = 0;            ///< of contact work, instructions
  double leniency = 1.0;      ///< 1 to 6: factor of the tolerance's speed-dependent part; grows after ticks cut short
  double pace_m_per_s = 0.0;  ///< half the relative speed of the hands; decays exponentially once they stop
  bool labours = false;       ///< the last tick used most of its budget, so this one has fewer substeps
  bool letting_go = false;    ///< a hold was released, and the thread is still fast
  bool new_matrix = false;    ///< Newton's inverse matrix of the last tick serves no more
  LIGATURE_MEMBERS(Plan, substeps, budget, leniency, pace_m_per_s, labours, letting_go, new_matrix)
};

[[nodiscard]] Plan plan(const Plan& last, const TickReport& report, const Situation& now,
                        const Numerics& numerics) noexcept;

/// How long a substep may wait that Newton's method has not solved. A waiting substep is continued in the next tick.
/// After limit_ ticks of waiting, sweeps solve the substep instead, and the limit becomes smaller.
class Patience {
 public:
  /// May the present substep wait for one more tick?
  [[nodiscard]] bool lasts() const noexcept { return waits_ + 1 <= limit_; }
  [[nodiscard]] bool waits() const noexcept { return waits_ > 0; }
  [[nodiscard]] bool sweeps_only() const noexcept { return sweeps_only_; }  ///< solve without Newton's method

  void newton_solved() noexcept { limit_ = std::min(tuning.patience, limit_ + 1.0); }
  /// Newton's method ended without a solution: `unsolved` if more work would not help, `spent` if too little work is
  /// left for sweeps. @return whether the substep waits.
  [[nodiscard]] bool newton_failed(bool unsolved, bool spent) noexcept {
    sweeps_only_ = unsolved || waits_ + 2 > limit_;
    return lasts() && (!unsolved || spent);
  }
  void put_off() noexcept { ++waits_; }
  /// The substep was solved, and the thread moves.
  void moved() noexcept {
    if (sweeps_only_ && waits_ > 0) limit_ *= tuning.patience_less;
    if (limit_ < 1.0) limit_ += tuning.patience_more;
    waits_ = 0;
    sweeps_only_ = false;
  }
  LIGATURE_MEMBERS(Patience, waits, limit, sweeps_only)

 private:
  int waits_ = 0;                   // consecutive ticks in which the present substep was begun but not finished
  double limit_ = tuning.patience;  // of waits_
  bool sweeps_only_ = false;
};

}  // namespace ligature::physics::rod
