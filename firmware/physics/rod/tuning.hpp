#pragma once
// The numbers of the rod that were chosen, not derived. (Prices are in work.hpp; room for lists is beside the lists.)

namespace ligature::physics::rod {

/// Each row: what the number is and its unit; the law or the measurement behind it; a test of what it serves. "d"
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
  /// Pairs with a gap below this multiple of near_d are measured between smooth curves, all others between straight
  /// segments. Test: Sliding.IsSmooth
  double close = 2.0;
  /// A pair without an impulse is no contact if a nearer pair has its points within place_d on both strands, d. Time
  /// lost while a surgeon's knot is pulled at 0.25 m/s with 6.5 million instructions: 9.5 % without it, 1.2 % with 0.5.
  /// A pair with an impulse counts as nearer by place_stays_d, d. With 0, contacts alternate and 1.5 % is lost; with
  /// more than the overlap of loaded strands, hooked strands pass through each other. Test: Places.*, Hooked.*
  double place_d = 0.5, place_stays_d = 0.003;
  /// Stiffness of a contact, N/m: 2 N overlap by 1 % of a diameter. Rigid contacts of straight segments have no
  /// solution in a tight loop. Test: Overhand.HoldsAfterAPullToFiveNewtons
  double contact_N_per_m = 6e5;
  /// Share of an overlap that a substep removes, and the largest speed at which it does so, m/s. Test:
  /// Overhand.MayBeLetGoAtTenNewtons
  double recovery = 0.3, max_recovery_m_per_s = 0.5;
  /// Largest distance by which the smooth curve cuts a corner, d: below 1/2, so that chords cannot cross while curves
  /// touch. Test: Smooth.CutsNoMoreThanStrandsCanSpare
  double most_cut_d = 0.35;
  /// Bounds of Aitken's relaxation of contact points: least share, largest growth. Test: Touch.ComesToRest*
  double least_share = 0.02, more_share = 1.2;
  /// Slip below which a contact counts as sticking, m/s: 1/30 d per second. Test: StaticFriction.DoesNotCatch*
  double stick_m_per_s = 1e-5;
  /// Gap of two neighbours along the thread below which they are a contact, as a share of their gap on a straight
  /// thread. It matters only for segments shorter than d. With 1/3 a pulled square knot overlapped by 0.09 d instead of
  /// 0.05 d. Test: Hold.OfTwoThrows*
  double bent = 2.0 / 3.0;
  /// For two neighbours along the thread: if the gap of their bounding spheres is more than this share of their gap on
  /// a straight thread, their exact distance is not computed. It affects only the cost: pulled and held square and
  /// surgeon's knots do not differ between 0.8 and 0.999. Test: Growth.AListCosts*
  double straight = 0.95;

  // ---- How exactly contacts are solved ----
  /// Tolerance of a velocity, m/s; and what is added to it for each m/s of half the hands' relative speed. With 0.012
  /// corners of segments hooked onto each other in 9 of 20 pulls, with 0.004 in none of 5. Test: Overhand.*
  double settled_m_per_s = 3e-5, settled_share = 0.004;
  /// Least tolerance of Newton's method, m/s: its single precision leaves 5 um/s in a held knot. With this tolerance a
  /// thread at rest does not drift, as it would with the sweeps, because Newton's method does not change impulses that
  /// have converged. It saves 4 % of the work of a knot at rest. Test: Hold.OfTwoThrowsAtRest* (bounds that work)
  double newton_m_per_s = 1e-5;
  /// Share of the thread's own speed that counts as speed of the hands when the tolerance is chosen; the larger of the
  /// two speeds is used. Test: Overhand.MayBeLetGoAtTenNewtons
  double stir = 0.15;
  /// The tolerance is at most this share of the fastest node's speed, but at least still_m_per_s: a thread at rest does
  /// not creep. Test: StaticFriction.HoldsUpTo*
  double creep = 0.1, still_m_per_s = 1e-6;
  /// Leniency, a factor on the tolerance: its largest value, its growth after a tick that was cut short, its decay
  /// after any other. Test: Plan.ToleranceGrows*
  double most_leniency = 6.0, leniency_up = 1.5, leniency_down = 0.9;
  /// Time constant, s, with which the remembered speed of the hands decays once they stop. 0.005 to 0.1 makes no
  /// difference. Test: Plan.Pace*
  double pace_s = 0.02;
  /// Residual at which Newton's method ends, as a multiple of the tolerance that the sweeps have: newton_near;
  /// newton_near x newton_old at a check after the first, when the matrix may be old. Once the fair share of the work
  /// is used, newton_near x the larger of newton_loose x this tolerance and `enough` x settled_m_per_s will do. Test:
  /// Labour.IsSharedFairly
  double newton_near = 3.0, newton_loose = 3.0, enough = 10.0, newton_old = 10.0;
  /// Most Newton steps between two checks of all contacts, and most checks. Test: ContactNewton.*
  int most_steps = 48, most_looks = 12;
  /// Sweeps over the dense system before the first Newton step, each with this share of a full step: a full step leaves
  /// a larger error in neighbouring contacts. Test: ContactNewton.FindsWhatSweepsFindInTheEnd
  int sweeps = 2;
  double sweep_share = 0.8;
  /// The inverse matrix is renewed after this many checks, or when the window grows by more than this many nodes. A
  /// contact's couplings are renewed when its weights change by more than `moved`, and dropped after `idle` substeps
  /// without load. Test: Hold.MovesOnlyWhatIsSettledInTheTrueMatrix
  int stale = 3, margin = 6, idle = 4;
  double moved = 0.16;
  /// Proximal term of Newton's method, relative to the contact's own response: along the normal, across it. Its factor
  /// fades with each step, faster when no kind has changed; it grows when the error has grown by more than cost_worse.
  /// Substeps of recorded two-throw pulls that did not converge: 111 of 3294; 200 with a factor that fades to 0.15 or
  /// 0. Test: Hold.OfTwoThrowsIsSlackenedInTime
  double cost_normal = 0.05, cost_along = 0.1, cost_fade = 0.6, cost_fade_known = 0.1;
  double cost_worse = 2.0, cost_more = 4.0, cost_least = 1e-4;

  // ---- What is given up when the work does not suffice ----
  /// Contact budget of a tick, instructions, and its part for each node: what a tick can afford. Test: Work.*
  long work = 4'300'000, work_per_node = 2500;
  /// Substeps of a tick; their share, and least number, after a tick that used the budget up; their share while a
  /// released thread flies. With six the errors cause overlaps, which cost more than was saved. Test: Labour.LeavesTen*
  int substeps = 16, fewest_substeps = 10;
  double labour_share = 0.625, letting_go_share = 1.5;
  /// Shares of the budget. A tick that used more than `tired` is followed by ticks with fewer substeps, until one uses
  /// less than `rested`. Test: Plan.Substeps*
  double tired = 0.9, rested = 0.25;
  /// Speed above which a released thread still flies, m/s. Test: Plan.SubstepsFollowTheTable
  double thrown_m_per_s = 10.0;
  /// Speed above which a hand is fast, m/s. Above it the budget of a tick grows by the share half_rush, above twice
  /// this speed by the share rush. Test: Overhand.IsDrawnTightWithoutStandingStill
  double fast_m_per_s = 0.3, rush = 0.75, half_rush = 0.25;
  /// Most ticks for which an unsolved substep may wait; the factor on this limit when waiting did not help; and its
  /// growth per substep while it is below 1. Test: Patience.*
  double patience = 12.0, patience_less = 0.8, patience_more = 0.02;
  /// Factor on all velocities after a tick in which the thread could not be moved at all: with slower nodes the next
  /// tick has fewer pairs to check. Test: Work.*
  double slowed = 0.5;
  /// Most and fewest passes of the sweeps in a substep. At most so many contact rows are solved that the budget
  /// suffices for the fewest passes. Test: Work.*
  int max_passes = 80, least_passes = 3;
  /// The brake scales velocities down if the last pass changed one by more than wild_m_per_s. What it allows in a
  /// substep: strands may deepen an overlap by brake_creep_d, d (at 2e-3 a jammed square knot lost half of its
  /// tension); a strand may overlap a body by brake_give times the distance of touch. Test: Unsettled.*
  double wild_m_per_s = 1e-3, brake_creep_d = 1e-4, brake_give = 0.3;
  /// Shares of work. looks_reserve: kept for each later contact detection, in costs of the last one. pass_share: for
  /// passes, in equal shares. unworked: part of the budget below which Newton's method has left too little for sweeps.
  /// Test: Labour.FindsTime*
  double looks_reserve = 1.5, pass_share = 2.0, unworked = 0.25;
  /// Time for which a list of pairs is made valid, in ticks, and the share of the budget that it may cost. If a list
  /// costs more, the next shorter time is tried; the last one is none at all. Test: Growth.*
  double ahead1_ticks = 1.2, ahead1_share = 0.3, ahead2_ticks = 0.15, ahead2_share = 0.25, ahead3_share = 0.4;

  // ---- Mesh ----
  /// Wanted angle between neighbouring segments, rad; in the initial mesh. Test: FineZone.CoversWhatLiesAgainstIt
  double turn_rad = 0.35, start_turn_rad = 0.5;
  /// Wanted length of segments at a contact, in units of sqrt(EI / T) (EI bending stiffness, T tension), and how much
  /// the wanted length grows per length along the thread. Test: FineZone.*
  double bend_length = 0.4, grading = 0.2;
  /// Offsets that remeshing leaves: factor on them per tick where the thread is at rest; motion in a tick, in mesh
  /// units, at which they fade to 1/e. Test: FineZone.MovesWithoutAForceStep
  double fade = 0.8, away = 0.5;
  /// Energy that the fading of remeshing offsets may add to a thread that is alone (glossary): a share of what the tick
  /// has dissipated, plus a share of the bending energy. Test: Energy.NeverRises*
  double fade_share = 0.5, fade_least = 1e-6;
  /// Slip below which a contact is at rest, and slip above which it has no effect on the lengths of its segments, m/s;
  /// wanted length of a segment at rest against a segment of unit length, in units. Test:
  /// FineZone.ReachesTheLoopThatTouches
  double rests_m_per_s = 1e-3, swings_m_per_s = 0.05, first = 0.7;
  /// Least factor by which a change improves the worst ratio; most merges tried for a change; most changes in a tick;
  /// most work for them, share of the budget. Test: Remesh.*
  double worth = 1.5, remesh_share = 0.125;
  int tries = 4, changes = 6;
};

#ifdef LIGATURE_ABLATION
inline Tuning tuning;  ///< the study rod_ablate changes it
#else
inline constexpr Tuning tuning;  // NOLINT(readability-identifier-naming): read as tuning.name everywhere
#endif

}  // namespace ligature::physics::rod
