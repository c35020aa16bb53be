#pragma once
// The data of a rod, in structs that a copy treats differently (see the class Rod).

#include <vector>

#include "firmware/physics/members.hpp"
#include "firmware/physics/rod/contact/contact_set.hpp"
#include "firmware/physics/rod/mesh/refine.hpp"
#include "firmware/physics/rod/model/assembly.hpp"
#include "firmware/physics/rod/model/twist.hpp"
#include "firmware/physics/rod/plan.hpp"
#include "firmware/physics/rod/tick_report.hpp"

namespace ligature::physics::rod {

class Rod;

/// Effects that a scene models. Rod::substep() is compiled for each combination of effects, so an absent effect costs
/// nothing.
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
  LIGATURE_MEMBERS(Parts, twist, contact, friction, world, adaptive, roll, turning, set, drum)

  bool operator==(const Parts&) const = default;
  /// Does every segment have a material frame? With `roll` the frames are turned in every substep, otherwise once per
  /// tick.
  [[nodiscard]] constexpr bool frames() const noexcept { return roll || set; }
};

/// What surrounds a thread.
struct World {
  Vec gravity{};
  double floor_m = 0.0, floor_friction = 0.3;
  bool has_floor = false;
  std::vector<Body> bodies;
  LIGATURE_MEMBERS(World, gravity, floor_m, floor_friction, has_floor, bodies)
};

/// The thread's motion, and the state of the rules that adapt the work to the computing time. Rod::continue_from()
/// takes over this, and spin_ if both rods have frames.
struct RodCourse {
  State state_;
  Forces forces_;
  Twist twist_;
  Refine refine_;
  TickReport report_;
  Patience patience_;
  bool released_ = false;  ///< a hold was released since the last tick
  bool alone_ = false;     ///< at most one hold, and nothing that holds or touches the thread moves (glossary)
  bool faded_ = false;     ///< the remeshing offsets have already been reduced for the next tick
  bool remeshed_ = false;  ///< nodes moved along the thread since Spin was last updated
  double kept_J_ = 0.0;    ///< alone only: total energy at the end of the last tick
  double give_J_ = 0.0;    ///< elastic energy of the contacts
  LIGATURE_MEMBERS(RodCourse, state, forces, twist, refine, report, patience, released, alone, faded, remeshed, kept_J,
                   give_J)
};

/// What a copy takes over in addition.
struct RodMatter {
  Material material_;
  Numerics numerics_;
  Parts parts_;
  bool (Rod::*substep_)(double) noexcept = nullptr;  ///< Rod::substep() for these parts
  double near_m_ = 0.0;                              ///< gap below which a pair is a contact at any speed
  Spin spin_;
  ContactSet contacts_;
  Motion motion_;
  bool mesh_held_ = false;  ///< the caller remeshes by Rod::remesh()
  /// The members that an image saves (image.hpp): all but substep_, which follows from parts_.
  [[nodiscard]] static auto members(RodMatter& self) noexcept {
    auto& [material, numerics, parts, substep, near_m, spin, contacts, motion, mesh_held] = self;
    return std::tie(material, numerics, parts, near_m, spin, contacts, motion, mesh_held);
  }
};

/// What lasts from tick to tick. A copy takes over all of it.
struct RodKept : World, RodCourse, RodMatter {};

/// What belongs to the tick under way. Every tick begins with a new one.
struct RodNow {
  double pace_m_per_s_ = 0.0;   ///< half the relative speed of the hands
  double stir_m_per_s_ = 0.0;   ///< largest nodal speed relative to the mean velocity
  double tick_travel_m_ = 0.0;  ///< upper bound of any node's travel since the tick began
  int substep_index_ = 0;
  bool measured_ = false;               ///< contact detection of this substep is complete
  double since_look_s_ = 0.0;           ///< time moved since contacts were detected
  long look_cost_ = 0, rows_cost_ = 0;  ///< work of the last substep's contact detection; work of its rows
  ContactReport seen_;                  ///< result of the contact solver in this substep
  bool braked_ = false;  ///< velocities of the last substep were scaled down after the hand forces were computed
};

/// Data that is computed again when it is missing, the memory for this data, and the clock. A rod to which another one
/// is assigned keeps its own memory and clock, and marks this data as missing.
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
  /// The members that an image saves (image.hpp): all but v_before_ and solver_, which every substep fills again.
  [[nodiscard]] static auto members(RodCache& self) noexcept {
    auto& [solver, metric, metric_dt, broad, horizon_s, stale, work, v_before] = self;
    return std::tie(metric, metric_dt, broad, horizon_s, stale, work);
  }
};

}  // namespace ligature::physics::rod
