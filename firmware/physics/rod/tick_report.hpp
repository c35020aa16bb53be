#pragma once
// What a tick of the rod did, and what it gave up.

#include "firmware/physics/members.hpp"

namespace ligature::physics::rod {

/// Counters and measures of one tick. `passes` counts sweeps and Newton steps; `contacts` are those of the last
/// substep, with and without load.
struct TickReport {
  int substeps = 0, passes = 0, contacts = 0, guard_events = 0, broad_phases = 0, remeshes = 0;
  double min_gap_m = 1e9;  ///< smallest thread-thread gap in any substep; negative: overlap
  long work = 0;           ///< instructions spent on contact, out of Numerics::budget()

  double set_J = 0.0;  ///< energy dissipated by plastic bending

  // What was given up for lack of budget or time, the mildest loss first.
  int cut_short = 0;       ///< substeps whose contact solver stopped before it converged
  int rows_left_out = 0;   ///< largest number of contacts in a substep that only the guard kept apart
  double time_lost = 0.0;  ///< share of the tick in which the thread was not moved, as no safe motion was known
  int cut_at = -1;         ///< number of the clock query that ended the tick early (time_left.hpp); -1: none did
  LIGATURE_MEMBERS(TickReport, substeps, passes, contacts, guard_events, broad_phases, remeshes, min_gap_m, work, set_J,
                   cut_short, rows_left_out, time_lost, cut_at)
};

}  // namespace ligature::physics::rod
