#pragma once
// The data of a rod, in parts by what a copy does with them.

#include <vector>

#include "firmware/physics/rod/assembly.hpp"
#include "firmware/physics/rod/contact.hpp"
#include "firmware/physics/rod/refine.hpp"
#include "firmware/physics/rod/twist.hpp"

namespace ligature::physics::rod {

class Rod;

/// Effects that a scene models. Rod::substep is compiled once per combination, so an absent effect costs nothing.
struct Parts {
  bool twist = true;
  bool contact = true;  ///< contact of the thread with itself
  bool friction = true;
  bool world = false;     ///< contact with floor and bodies
  bool adaptive = false;  ///< remeshing: nodes move along the thread to where a fine mesh is needed (refine.hpp)
  bool roll = false;      ///< every segment has its own roll angle (spin.hpp); needs twist
  bool turning = false;   ///< contact friction rolls the thread about its axis; needs roll and friction
  bool set = false;       ///< plastic bending: sharp bends become permanent (spin_set.cpp); needs twist
  bool drum = false;      ///< bars whose surface turns; needs contact, friction and world

  bool operator==(const Parts&) const = default;
  /// Does every segment have a material frame? With `roll` the frames turn in every substep, otherwise once per tick.
  [[nodiscard]] constexpr bool frames() const noexcept { return roll || set; }
};

/// Counters and measures of one tick.
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
};

/// What surrounds a thread.
struct World {
  Vec gravity{};
  double floor_m = 0.0, floor_friction = 0.3;
  bool has_floor = false;
  std::vector<Body> bodies;
};

/// The thread's motion, and what earlier ticks have taught the rules that adapt to it: all that Rod::continue_from()
/// takes over.
struct RodCourse {
  static constexpr double kPatience = 12.0;  ///< most ticks for which an unsolved substep may be continued

  State state_;
  Forces forces_;
  Twist twist_;
  Refine refine_;
  TickReport report_;
  double pace_m_per_s_ = 0.0;    ///< half the relative speed of the hands; decays exponentially once they stop
  double leniency_ = 1.0;        ///< 1 to 6: factor of the tolerance's speed-dependent part; grows after cut ticks
  int waits_ = 0;                ///< consecutive ticks in which the present substep was begun but not finished
  double patience_ = kPatience;  ///< limit of waits_: falls when waiting did not help, rises when Newton converges
  bool sweeps_only_ = false;     ///< the next substep is solved without Newton's method
  bool labours_ = false;         ///< the last tick used most of its budget, so this one has fewer substeps
  bool released_ = false;        ///< a hold was released since the last tick
  bool letting_go_ = false;      ///< a hold was released, and the thread is still fast
  bool alone_ = false;           ///< at most one hold, and nothing that holds or touches the thread moves (glossary)
  bool faded_ = false;           ///< the remeshing offsets have already been reduced for the next tick
  bool remeshed_ = false;        ///< nodes moved along the thread since Spin was last updated
  double kept_J_ = 0.0;          ///< alone only: total energy at the end of the last tick
  double give_J_ = 0.0;          ///< elastic energy of the contacts
};

/// What lasts from tick to tick. A copy takes over all of it.
struct RodKept : World, RodCourse {
  Material material_;
  Numerics numerics_;
  Parts parts_;
  bool (Rod::*substep_)(double) noexcept = nullptr;  ///< Rod::substep() for these parts
  double near_m_ = 0.0;                              ///< gap below which a pair is a contact at any speed
  Spin spin_;
  ContactSet contacts_;
  Motion motion_;
  long list_cost_ = 0;      ///< work of the last broad phase
  bool mesh_held_ = false;  ///< the caller remeshes by Rod::remesh()
};

/// What belongs to the tick under way. Every tick begins with a new one.
struct RodNow {
  double stir_m_per_s_ = 0.0;   ///< largest nodal speed relative to the mean velocity
  double tick_travel_m_ = 0.0;  ///< upper bound of any node's travel since the tick began
  int substep_index_ = 0;
  bool measured_ = false;              ///< contact detection of this substep is complete
  double since_look_s_ = 0.0;          ///< time moved since contacts were detected
  long look_cost_ = 0, rows_cost_ = 0;  ///< work of the last substep's contact detection; work of its rows
  ContactReport seen_;                 ///< result of the contact solver in this substep
  bool braked_ = false;  ///< velocities of the last substep were scaled down after the hand forces were computed
};

/// What is computed again when it is missing, memory for it, and the clock. A copy keeps its own and forgets the
/// contents.
struct RodCache {
  BandSolver solver_;
  ContactMetric metric_;
  double metric_dt_ = 0.0;  ///< time step for which metric_ was computed
  BroadPhase broad_;
  double horizon_s_ = 0.0;     ///< time for which the list of pairs is valid if speeds stay as when it was built
  bool stale_ = true;          ///< the list of pairs must be rebuilt
  Work work_;                  ///< with the tick's clock, which measures this machine
  std::vector<Vec> v_before_;  ///< velocities at the start of the substep

  void forget() noexcept { metric_.invalidate(), stale_ = true; }
};

}  // namespace ligature::physics::rod
