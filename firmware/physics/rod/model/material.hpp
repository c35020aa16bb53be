#pragma once
// Material of a rod, and settings of its time integration and contact solver. SI units.

#include <vector>

#include "firmware/physics/members.hpp"
#include "firmware/physics/rod/tuning.hpp"

namespace ligature::physics::rod {

/// A part of the thread with a bending stiffness of its own, for example a swaged end.
struct StiffRegion {
  double from_m, to_m;  ///< material coordinates
  double EI_N_m2;
  LIGATURE_MEMBERS(StiffRegion, from_m, to_m, EI_N_m2)
};

/// A round, isotropic rod. Constant during a run.
struct Material {
  double length_m = 0.3;
  double radius_m = 1.5e-4;
  double density_kg_per_m = 8e-5;
  double EA_N = 71.0;           ///< axial stiffness
  double EI_N_m2 = 4e-7;        ///< bending stiffness B
  double GJ_N_m2 = 2.86e-7;     ///< twisting stiffness C
  double stretch_tau_s = 5e-4;  ///< Kelvin-Voigt time: damping force = tau x stiffness x rate
  double bend_tau_s = 2e-3;
  double drag_per_s = 5.0;             ///< c of the air drag a = -c v
  double friction = 0.3;               ///< coefficient of sliding (Coulomb) friction
  double static_friction = 0.0;        ///< coefficient of static friction; used where it exceeds `friction`
  double born_curvature_per_m = 0.0;   ///< curvature of the stress-free thread, about a material axis (spin.hpp)
  double born_twist_per_m = 0.0;       ///< twist of the stress-free thread, rad/m
  double yield_curvature_per_m = 0.0;  ///< 2 x yield strain / diameter: sharper bends set (spin_set.cpp); 0: off
  double set_fraction = 0.0;           ///< share of the bending stiffness that yields beyond this curvature
  std::vector<StiffRegion> regions;    ///< where the bending stiffness is not EI_N_m2; in order, without overlap

  [[nodiscard]] constexpr bool sets() const noexcept { return yield_curvature_per_m > 0.0 && set_fraction > 0.0; }
  /// Is there a stress-free shape that is not straight?
  [[nodiscard]] constexpr bool has_shape() const noexcept { return born_curvature_per_m != 0.0 || sets(); }
  LIGATURE_MEMBERS(Material, length_m, radius_m, density_kg_per_m, EA_N, EI_N_m2, GJ_N_m2, stretch_tau_s, bend_tau_s,
                   drag_per_s, friction, static_friction, born_curvature_per_m, born_twist_per_m, yield_curvature_per_m,
                   set_fraction, regions)
};

/// Time steps, tolerances and work limits. Each field is a compromise between computing time and accuracy
/// (docs/rod-contact.md).
struct Numerics {
  double tick_s = 1e-3;
  int substeps = tuning.substeps;                   ///< time steps per tick
  int max_substeps = tuning.substeps;               ///< time steps per tick when the motion is fast (plan.hpp)
  int max_passes = 1 << 30;                         ///< most passes of the sweep solver per substep; as here: no limit
  long work = tuning.work;                          ///< contact budget of a tick, in instructions (work.hpp)
  long work_per_node = tuning.work_per_node;        ///< added to the budget for each node
  long given_work = 0;                              ///< > 0: replaces the whole budget, for any thread
  double settled_m_per_s = tuning.settled_m_per_s;  ///< tolerance: a pass that changes no velocity by more is the last
  double settled_share = tuning.settled_share;      ///< added to it: this times half the hands' relative speed
  double recovery = tuning.recovery;                ///< share of a penetration that a substep removes
  double contact_N_per_m = tuning.contact_N_per_m;  ///< stiffness of a contact

  /// Contact budget of a tick, in instructions.
  [[nodiscard]] constexpr long budget(int nodes) const noexcept {
    return given_work > 0 ? given_work : work + work_per_node * nodes;
  }
  LIGATURE_MEMBERS(Numerics, tick_s, substeps, max_substeps, max_passes, work, work_per_node, given_work,
                   settled_m_per_s, settled_share, recovery, contact_N_per_m)
};

}  // namespace ligature::physics::rod
