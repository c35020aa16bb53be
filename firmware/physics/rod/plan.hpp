#pragma once
// The rules of a tick: how many time steps it has, how exactly contacts are solved, and how long a step may wait.

#include <algorithm>

#include "firmware/physics/members.hpp"
#include "firmware/physics/rod/model/material.hpp"
#include "firmware/physics/rod/tick_report.hpp"

namespace ligature::physics::rod {

/// What decides about the time steps of a tick. Lengths are in thread diameters.
struct Situation {
  double hand_d = 0.0;    ///< motion of the fastest hold in a tick
  double node_d = 0.0;    ///< motion of the fastest node in a tick
  bool released = false;  ///< a hold was released since the last tick
  bool waits = false;     ///< a substep that the last tick began is not solved yet

  /// A hand moves by more than a diameter in a tick; or the thread flies: a hold was just released, or a node moves by
  /// more than a diameter in a substep.
  [[nodiscard]] bool is_fast(const Numerics& numerics) const noexcept {
    constexpr double kAlmost = 1e-9;  // so that rounding does not decide about a hand of just this speed
    return hand_d > 1.0 + kAlmost || released || node_d > numerics.max_substeps;
  }
};

/// Number of substeps of the next tick. It is largest when the motion is fast. While a substep waits, it stays. It is
/// halved, but not below tuning.fewest_substeps, when the last tick used a large part of its work, or the clock ended
/// it.
/// @param last    what the last tick did
/// @param budget  of a tick, instructions
[[nodiscard]] inline int substeps_of(const Situation& now, const TickReport& last, long budget,
                                     const Numerics& numerics) noexcept {
  if (now.is_fast(numerics)) return numerics.max_substeps;
  if (now.waits) return last.substeps;
  const bool labours =
      static_cast<double>(last.work) > tuning.labours * static_cast<double>(budget) || last.cut_at >= 0;
  return labours ? std::min(numerics.substeps, std::max(tuning.fewest_substeps, numerics.substeps / 2))
                 : numerics.substeps;
}

/// Whether the inverse matrix of Newton's method must be computed anew: the last tick had another time step, or the
/// motion is fast, which changes the thread's shape.
[[nodiscard]] inline bool needs_new_matrix(const Situation& now, int substeps, int last,
                                           const Numerics& numerics) noexcept {
  return substeps != last || (now.is_fast(numerics) && !now.waits);
}

/// Speeds that decide how exactly contacts are solved, m/s.
struct Speeds {
  double hands = 0.0;    ///< half the relative speed of the hands
  double own = 0.0;      ///< largest nodal speed relative to the mean velocity
  double fastest = 0.0;  ///< largest nodal speed
};

/// Tolerance of the contact solver, m/s: a pass that changes no velocity by more is the last. It grows with the speed
/// of the hands or, as after a release, of the thread itself, but stays below a tenth of the fastest node's speed, so
/// that a nearly resting thread does not drift. For a thread that is alone (glossary) its own speed does not count:
/// with contacts that close 0.01 m/s too fast, a released surgeon's knot gained 3 % of its stored energy.
[[nodiscard]] inline double tolerance(const Speeds& now, bool alone, const Numerics& numerics) noexcept {
  const double speed = std::max(now.hands, alone ? 0.0 : tuning.stir * now.own);
  return std::min(numerics.settled_m_per_s + numerics.settled_share * speed,
                  tuning.creep * std::max(numerics.settled_m_per_s, now.fastest));
}

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
