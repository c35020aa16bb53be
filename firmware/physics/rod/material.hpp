#pragma once
// What a rod is made of and how finely its motion is computed. SI units.

namespace ligature::physics::rod {

/// A round, isotropic rod. Constants of a run.
struct Material {
  double length_m = 0.3;
  double radius_m = 1.5e-4;
  double density_kg_per_m = 8e-5;
  double EA_N = 71.0;           ///< axial stiffness
  double EI_N_m2 = 4e-7;        ///< bending stiffness B
  double GJ_N_m2 = 2.86e-7;     ///< twisting stiffness C
  double stretch_tau_s = 5e-4;  ///< Kelvin-Voigt time: damping force = tau x stiffness x rate
  double bend_tau_s = 2e-3;
  double drag_per_s = 5.0;             ///< air: a = -c v
  double friction = 0.3;               ///< Coulomb coefficient of what slides
  double static_friction = 0.0;        ///< of what sticks; the same as friction when that is more
  double born_curvature_per_m = 0.0;   ///< of the stress-free thread, about a material axis (spin.hpp)
  double born_twist_per_m = 0.0;       ///< of its material frame, rad/m
  double yield_curvature_per_m = 0.0;  ///< beyond which bends set (spin_set.cpp), 2 x yield strain / diameter; 0: never
  double set_fraction = 0.0;           ///< share of the bending stiffness that gives way there

  [[nodiscard]] constexpr bool sets() const noexcept { return yield_curvature_per_m > 0.0 && set_fraction > 0.0; }
  /// Is there a stress-free shape that is not straight?
  [[nodiscard]] constexpr bool has_shape() const noexcept { return born_curvature_per_m != 0.0 || sets(); }
};

/// How a tick is cut and how hard contacts are solved. Every field is a trade of time for accuracy
/// (docs/rod-contact.md).
struct Numerics {
  double tick_s = 1e-3;
  int substeps = 16;      ///< of a tick,
  int max_substeps = 16;  ///< when the hands are faster than fast_m_per_s
  double fast_m_per_s = 0.3;
  int max_passes = 80;            ///< true solves per substep while contacts settle
  long work = 4'300'000;          ///< what contact may cost in a tick, in instructions (work.hpp),
  long work_per_node = 2500;      ///< and for each node besides; a quarter more for fast hands,
  double rush = 0.75;             ///< and this share for hands faster than 2 fast_m_per_s;
  long given_work = 0;            ///< > 0: this instead, whatever the nodes and the hands
  double settled_m_per_s = 3e-5;  ///< a pass that changes no velocity by more ends them,
  double settled_share = 0.004;   ///< or than that and this share of half the speed at which the ends are parted
  /// Newton's method is in single precision, which leaves 5 um/s in a held knot, so it aims at no less than this. What
  /// rests does not creep by it, as sweeps and their mixing do: impulses that are settled stay what they are.
  double newton_m_per_s = 1e-5;
  double recovery = 0.3;  ///< share of a penetration taken back per substep
  double max_recovery_m_per_s = 0.5;
  double contact_N_per_m = 6e5;  ///< give of a contact under load

  [[nodiscard]] constexpr bool is_fast(double hand_m_per_s) const noexcept {
    return hand_m_per_s > 1.001 * fast_m_per_s;
  }
  /// Work of a tick for a thread of so many nodes.
  [[nodiscard]] constexpr long budget(int nodes, double hand_m_per_s) const noexcept {
    if (given_work > 0) return given_work;
    const auto whole = static_cast<double>(work + work_per_node * nodes);
    const double more = is_fast(0.5 * hand_m_per_s) ? rush : is_fast(hand_m_per_s) ? 0.25 : 0.0;
    return static_cast<long>((1.0 + more) * whole);
  }
};

}  // namespace ligature::physics::rod
