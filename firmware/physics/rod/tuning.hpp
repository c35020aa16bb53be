#pragma once
// The numbers of the rod that were chosen, not derived. (Prices are in work.hpp; room for lists is beside the lists.)

namespace ligature::physics::rod {

/// Each comment: the number's meaning and unit; its law or measurement; a test of the behaviour that needs it. "d"
/// is the diameter of the thread. Rows without a unit are factors. tests/bench/rod/ablate.cpp (`rod_ablate`) changes
/// every number and shows what differs; tests/architecture/tuning_rules.py keeps such numbers out of the other files.
struct Tuning {
  // ---- Contact: where it begins and how stiff it is ----
  /// Gap below which a pair is a contact at any speed, d. Time lost while a square and a surgeon's knot are pulled at
  /// 0.2 m/s to 5 N: 9 and 20 % with 0.1; 10 and 23 % with 0.05 and also with 0.2 (one pull each). Test:
  /// Hold.OfTwoThrows*
  double near_d = 0.1;
  /// A pair at rest is on the contact list if its gap is below this distance, d. Test:
  /// Growth.TheListHoldsEveryPairItPromises
  double skin_d = 0.5;
  /// A pair without an impulse is no contact if a nearer pair has its points within place_d on both strands, d. Time
  /// lost while a surgeon's knot is pulled at 0.25 m/s with 6.5 million instructions: 9.5 % without it, 1.2 % with 0.5.
  /// A pair with an impulse counts as nearer by place_stays_d, d. With 0, contacts alternate and 1.5 % is lost; with
  /// more than the overlap of loaded strands, hooked strands pass through each other. Test: Places.*, Hooked.*
  double place_d = 0.5, place_stays_d = 0.003;
  /// Weight of the motion of a contact's points along the thread, beside that of their distance (touch.hpp). Square
  /// knots pulled at 0.1 to 0.3 m/s (120 pulls) used more than 4 million instructions in 2.7 % of the ticks of their
  /// hold with 0 (one of them in 71 %), in 0.4 % with 0.05 (12 %). Test: Touch.*
  double touch_lag = 0.05;
  /// Stiffness of a contact, N/m: 2 N overlap by 1 % of a diameter. Rigid contacts of straight segments have no
  /// solution in a tight loop. Test: Overhand.HoldsAfterAPullToFiveNewtons
  double contact_N_per_m = 6e5;
  /// Share of an overlap that a substep removes. Test: Overhand.MayBeLetGoAtTenNewtons
  double recovery = 0.3;
  /// Largest distance by which the smooth curve cuts a corner, d: below 1/2, so that chords cannot cross while curves
  /// touch. Test: Smooth.CutsNoMoreThanStrandsCanSpare
  double most_cut_d = 0.35;

  // ---- How exactly contacts are solved ----
  /// settled_m_per_s: tolerance of a velocity, m/s, and slip below which a contact sticks (1/10 d per second).
  /// settled_share: what is added to the tolerance for each m/s of half the hands' relative speed. With a share of
  /// 0.012 corners of segments hooked onto each other in 9 of 20 pulls, with 0.004 in none of 5. Test: Overhand.*
  double settled_m_per_s = 3e-5, settled_share = 0.004;
  /// Share of the thread's own speed that counts as speed of the hands when the tolerance is chosen; the larger of the
  /// two speeds is used. Test: Overhand.MayBeLetGoAtTenNewtons
  double stir = 0.15;
  /// The tolerance is at most this share of the fastest node's speed, or of settled_m_per_s where all nodes are slower.
  /// A thread at rest on a desk creeps at 0.07 um/s with this bound, and at 0.65 without it. Test:
  /// Friction.AThreadAtRestHardlyCreeps
  double creep = 0.1;
  /// Newton's method ends at a residual of newton_near times the tolerance that the sweeps have. newton_near^3 times
  /// the tolerance is enough at a check after the first, when the matrix may be old. Once the fair share of the work is
  /// used, newton_near^2 times the tolerance is enough, or newton_near^3 times settled_m_per_s if that is larger. Test:
  /// Labour.IsSharedFairly
  double newton_near = 3.0;
  /// The inverse matrix is renewed after `stale` checks. A contact's couplings are renewed when its weights change by
  /// more than `moved`. Test: Hold.MovesOnlyWhatIsSettledInTheTrueMatrix
  int stale = 3;
  double moved = 0.16;
  /// Proximal term of Newton's method, relative to the contact's own response along the normal, and across it twice as
  /// much; multiplied by the number of rises of the residual (contact_newton.hpp). With 1.5e-3 holds lose 0.14 % of
  /// their time instead of 0.06, with 7.5e-4 pulls of surgeon's knots 1.0 % instead of 0.9. Test:
  /// Labour.IsNeverUsedUpByCycles
  double proximal = 1e-3;

  // ---- What is given up when the work does not suffice ----
  /// Contact budget of a tick, instructions, and its part for each node: what `ligature-firmware admit` finds on usual
  /// machines (mostly 5.5 to 7 million with 154 nodes). Test: Work.*
  long work = 6'100'000, work_per_node = 2500;
  /// Substeps of a tick; after a tick that used more than the share `labours` of the budget, half of them, but at least
  /// fewest_substeps. With six the errors cause overlaps, which cost more than was saved. Without this rule pulls lose
  /// 0.3 % more of their time. Test: Labour.LeavesTen*, Substeps.*
  int substeps = 16, fewest_substeps = 10;
  double labours = 0.18;
  /// Most ticks for which an unsolved substep may wait. Test: Patience.*
  int patience = 12;

  // ---- Mesh ----
  /// Wanted angle between neighbouring segments, rad; in the initial mesh. With 0.35 there too, remeshing changed the
  /// force of fast pulls by 4.2 mN more than it may instead of 2.5 mN. Test: FineZone.MovesWithoutAForceStep
  double turn_rad = 0.35, start_turn_rad = 0.5;
  /// Wanted length of segments at a contact, in units of sqrt(EI / T) (EI bending stiffness, T tension), and how much
  /// the wanted length grows per length along the thread. Test: FineZone.*
  double bend_length = 0.4, grading = 0.2;
  /// Offsets that remeshing leaves (refine.hpp) shrink in each tick by the factor fade, and those of bends and of the
  /// smooth curve also by exp(-(m / away)^2); m: motion of the node in the tick, in lengths of the shortest segment.
  /// Without the second factor the force of sliding strands chatters by a third more (0.81 % instead of 0.61 %). Test:
  /// FineZone.MovesWithoutAForceStep
  double fade = 0.8, away = 0.5;
  /// Share of the energy that a tick has dissipated which this fading may give back to a thread that is alone
  /// (glossary). Energy rose in 6 of 12 releases of two throws with 1, in 2 with 1/2. With 0 a thread that is alone
  /// keeps bends that it should lose. Test: Energy.NeverRises*
  double fade_share = 0.5;
  /// Wanted length, in units, of both segments of a contact at rest if one of them should be a unit long. With 1, 12 of
  /// 32 tightened surgeon's knots had a segment of more than 1.2 d in contact, with 0.7 one had. Test:
  /// FineZone.ReachesTheLoopThatTouches
  double first = 0.7;
  /// A segment is split only if its ratio of length to wanted length is more than `worth` times that of the merged
  /// segment. Test: Remesh.*
  double worth = 1.5;
};

#ifdef LIGATURE_ABLATION
inline Tuning tuning;  ///< the study rod_ablate changes it
#else
inline constexpr Tuning tuning;  // NOLINT(readability-identifier-naming): read as tuning.name everywhere
#endif

/// Velocity error that is accepted when work runs short, m/s: the largest residual that Newton's method leaves in a
/// thread at rest with `balanced`. So slower slip counts as rest; and if the last pass of unconverged sweeps changed a
/// velocity by more, velocities are scaled down until no overlap deepens faster than this. Test: Unsettled.*
[[nodiscard]] inline double loose_m_per_s() noexcept {
  return tuning.newton_near * tuning.newton_near * tuning.newton_near * tuning.settled_m_per_s;
}

}  // namespace ligature::physics::rod
