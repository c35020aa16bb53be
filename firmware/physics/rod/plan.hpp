#pragma once
// Adapts the rod's work to the computing time that it has: each tick gets a plan, made from the plan of the last tick
// and from what happened in it.

#include "firmware/physics/members.hpp"
#include "firmware/physics/rod/model/material.hpp"
#include "firmware/physics/rod/tick_report.hpp"

namespace ligature::physics::rod {

/// What happens to the thread in a tick, and what came of the last one.
struct Situation {
  double hand_d = 0.0;         ///< motion of the fastest hold in a tick, thread diameters
  double apart_m_per_s = 0.0;  ///< largest relative speed of two holds; of a single hold: its speed
  bool released = false;       ///< a hold was released since the last tick
  bool waits = false;          ///< a substep that the last tick began is not solved yet
  double node_d = 0.0;         ///< motion of the fastest node in a tick, thread diameters
  int nodes = 0;
};

/// Rules of one tick. They depend on nothing but the arguments of plan(), so each can be tested without a thread.
struct Plan {
  int substeps = 0;
  long budget = 0;            ///< of contact work, instructions
  double leniency = 1.0;      ///< 1 to 6: factor of the tolerance's speed-dependent part; grows after ticks cut short
  double pace_m_per_s = 0.0;  ///< half the relative speed of the hands
  bool new_matrix = false;    ///< Newton's inverse matrix of the last tick serves no more
  LIGATURE_MEMBERS(Plan, substeps, budget, leniency, pace_m_per_s, new_matrix)
};

[[nodiscard]] Plan plan(const Plan& last, const TickReport& report, const Situation& now,
                        const Numerics& numerics) noexcept;

/// How long a substep may wait that Newton's method has not solved. A waiting substep is continued in the next tick.
/// After tuning.patience ticks, or if more work for Newton's method would not help, sweeps solve the substep.
class Patience {
 public:
  /// May the present substep wait for one more tick?
  [[nodiscard]] bool lasts() const noexcept { return waits_ < tuning.patience; }
  [[nodiscard]] bool waits() const noexcept { return waits_ > 0; }
  /// Is the substep to be solved without Newton's method?
  [[nodiscard]] bool sweeps_only() const noexcept { return failed_ || !lasts(); }

  void newton_failed() noexcept { failed_ = true; }  ///< more work would not help
  void put_off() noexcept { ++waits_; }
  void moved() noexcept { waits_ = 0, failed_ = false; }  ///< the substep was solved, and the thread moves
  LIGATURE_MEMBERS(Patience, waits, failed)

 private:
  int waits_ = 0;  // consecutive ticks in which the present substep was begun but not finished
  bool failed_ = false;
};

}  // namespace ligature::physics::rod
