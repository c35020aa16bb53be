#pragma once
// The rod: state, material, solvers and contacts together, and the tick that advances them.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "firmware/physics/rod/assembly.hpp"
#include "firmware/physics/rod/contact.hpp"
#include "firmware/physics/rod/refine.hpp"
#include "firmware/physics/rod/twist.hpp"

namespace ligature::physics::rod {

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

/// A simulated thread. Construct it, set its shape through state(), then call tick(). Only the constructor allocates.
/// A copy takes the whole state except the list of pairs and the contact matrices: these are large, and reset() copies
/// within the real-time loop, so the copy rebuilds them when it needs them.
class Rod {
 public:
  /// Starts straight along +x from the origin, at rest, with equally spaced nodes.
  /// @param n  number of nodes, >= 3
  Rod(const Material& material, const Numerics& numerics, const Parts& parts, int n, int bodies = 0);

  Rod(const Rod& other);
  Rod& operator=(const Rod& other);
  Rod(Rod&&) noexcept = default;
  Rod& operator=(Rod&&) noexcept = default;
  ~Rod() = default;

  Vec gravity{};
  double floor_m = 0.0, floor_friction = 0.3;
  bool has_floor = false;
  std::vector<Body> bodies;

  [[nodiscard]] State& state() noexcept { return state_; }
  [[nodiscard]] const State& state() const noexcept { return state_; }
  [[nodiscard]] const Material& material() const noexcept { return material_; }
  [[nodiscard]] Numerics& numerics() noexcept { return numerics_; }
  [[nodiscard]] const Numerics& numerics() const noexcept { return numerics_; }
  [[nodiscard]] Twist& twist() noexcept { return twist_; }
  [[nodiscard]] const Twist& twist() const noexcept { return twist_; }
  [[nodiscard]] const Spin& spin() const noexcept { return spin_; }  ///< used with Parts::frames() only
  [[nodiscard]] double twist_energy_J() const noexcept {
    return parts_.frames() ? spin_.energy_J(material_, state_) : twist_.energy_J();
  }
  [[nodiscard]] const Forces& forces() const noexcept { return forces_; }
  [[nodiscard]] const ContactSet& contact_set() const noexcept { return contacts_; }

  /// With Parts::adaptive: chooses the initial node spacing for a given curvature, 1/m, sampled at equal distances
  /// along the thread. Call before the first tick; the caller then sets positions from state().mesh.s.
  void spread(std::span<const double> curvature_per_m);

  /// Call after positions, clamps or spacing were changed from outside: recomputes the mesh constants and forgets the
  /// contacts. With Parts::frames() the thread then starts without twist.
  void moved() noexcept;

  /// Takes over the motion, holds and twist of another rod but keeps this one's material. No allocation.
  /// @return false, and nothing is changed, when the numbers of nodes differ.
  [[nodiscard]] bool continue_from(const Rod& other) noexcept;

  /// Three ways to hold a node. Each returns the index of the hold, or -1 when all kMaxHolds are in use.
  /// support: fixes the position p, m. clamp: also fixes the tangent along `direction`, and the roll.
  /// grip: a hand's spring and damper, f = K (tool - x) + B (v_tool - v) on the node, integrated implicitly; it keeps
  /// the present roll (holds_roll) and the present tangent (directed).
  /// O(1), or O(n) when a tangent is fixed; no allocation.
  int support(int node, Vec p) noexcept;
  int clamp(int node, Vec p, Vec direction) noexcept;
  int grip(int node, double stiffness_N_per_m, double damping_N_s_per_m, Vec tool, bool holds_roll = true,
           bool directed = false) noexcept;
  /// Ends a hold; the next ticks use more substeps while the released thread is fast. @pre a valid index of a hold.
  void release(int hold) noexcept;

  /// Advances by numerics().tick_s. `goals` are the targets of the holds at the end of the tick, m; for a hold that
  /// does not move, its present target. Cost: O(n) per substep, plus at most Numerics::budget() instructions for
  /// contact; no allocation, no exception. When the budget or the time `left` runs out, the thread is not moved for the
  /// rest of the tick, which report() tells.
  void tick(const std::array<Vec, kMaxHolds>& goals, const TimeLeft& left = {}) noexcept;
  void tick() noexcept;
  /// Call when the caller's work for this tick is done too: measures the time since the last clock query, which later
  /// ticks then reserve.
  void tick_ended() noexcept { work_.time().end(); }

  /// The remeshing step of a tick alone. @return true when nodes moved along the thread.
  bool remesh() noexcept;
  /// Turns a hold that fixes roll: from the next tick on its director points along `steer` and, if the hold is
  /// directed, its tangent along `direction`.
  void steer(int hold, Vec steer, Vec direction) noexcept;
  /// Switches remeshing inside tick() off (true) or on (false), for callers that call remesh() themselves.
  void hold_mesh(bool on) noexcept { mesh_held_ = on; }

  [[nodiscard]] const TickReport& report() const noexcept { return report_; }
  /// Energy without twist_energy_J(); the elastic energy of contacts is that at the end of the last tick.
  [[nodiscard]] Energy energy() const noexcept {
    Energy e = rod::energy(material_, state_, gravity);
    e.give_J = give_J_;
    return e;
  }
  /// Total energy: all terms of `e`, plus twist, the springs of the holds and the potential of the constant loads.
  [[nodiscard]] double all_J(const Energy& e) const noexcept;

 private:
  using Substep = bool (Rod::*)(double) noexcept;
  static Substep pick(const Parts& parts) noexcept;
  /// One time step of dt_s. @return false, and nothing is moved, when the budget or time left is too small.
  template <unsigned Bits>
  bool substep(double dt_s) noexcept;
  template <unsigned Bits>
  bool look(double dt_s) noexcept;
  bool list_is_good(double dt_s) noexcept;
  bool relist(long reserve) noexcept;
  template <unsigned Bits>
  bool settle(double dt_s) noexcept;
  void mesh_changed() noexcept;
  [[nodiscard]] bool sticks() const noexcept { return material_.static_friction > material_.friction; }
  /// Newton's method serves the tight contacts of knots; contact with floor and bodies is solved by sweeps.
  [[nodiscard]] bool solves_directly() const noexcept { return !parts_.turning && contacts_.only_pairs(); }
  /// Number of nodes that contacts act on (the window); work that rows with their fewest passes may use; work that rows
  /// with all their passes may use.
  struct Allowance {
    long window, rows, passes;
  };
  [[nodiscard]] Allowance work_allowed(bool metric_too) const noexcept;
  [[nodiscard]] double settled() const noexcept;
  std::optional<Effort> choose_rows(double dt_s) noexcept;
  [[nodiscard]] bool prepare_metric(double dt_s) noexcept;
  template <unsigned Bits>
  void move(double dt_s, double share) noexcept;
  template <unsigned Bits>
  std::optional<double> guard(double dt_s) noexcept;
  std::optional<double> guard_unseen(double dt_s) noexcept;
  template <bool Friction>
  Outcome settle_directly(const Effort& effort) noexcept;
  static constexpr double kPatience = 12.0;  ///< most ticks for which an unsolved substep may be continued
  [[nodiscard]] bool can_wait() const noexcept { return solves_directly() && waits_ + 1 <= patience_; }
  bool put_off() noexcept;
  bool give_up() noexcept;
  double brake(double dt_s) noexcept;

  /// Speed of the fastest hold, and largest relative speed of two holds (of a single hold: its speed), m/s.
  struct HandSpeed {
    double fastest = 0.0, apart = 0.0;
    int holds = 0;
  };
  HandSpeed set_hands(const std::array<Vec, kMaxHolds>& goals, std::array<Vec, kMaxHolds>& starts) noexcept;
  void begin_tick(const HandSpeed& hands, const TimeLeft& left) noexcept;
  /// Computes the coupling forces on the hands, at the node positions x + ahead_s v.
  void feel_hands(double ahead_s) noexcept;
  int add_hold(const Hold& hold) noexcept;
  /// Reduces the stress-free bends, strains and corner offsets that remeshing has left.
  void fade() noexcept;

  Material material_;
  Numerics numerics_;
  Parts parts_;
  State state_;
  Forces forces_;
  BandSolver solver_;
  ContactMetric metric_;
  ContactSet contacts_;
  BroadPhase broad_;
  Twist twist_;
  Spin spin_;
  Refine refine_;
  TickReport report_;
  Substep substep_;
  Work work_;
  long look_cost_ = 0, rows_cost_ = 0;  // work of the last substep's contact detection; work of its rows
  long list_cost_ = 0;                  // work of the last broad phase
  double metric_dt_ = 0.0;
  double pace_m_per_s_ = 0.0;    // half the relative speed of the hands; decays exponentially once they stop
  double leniency_ = 1.0;        // 1 to 6: factor of the tolerance's speed-dependent part; grows after ticks cut short
  bool braked_ = false;          // velocities of the last substep were scaled down after the hand forces were computed
  int waits_ = 0;                // consecutive ticks in which the present substep was begun but not finished
  double patience_ = kPatience;  // limit of waits_: falls when waiting did not help, rises when Newton converges
  bool sweeps_only_ = false;     // the next substep is solved without Newton's method
  double stir_m_per_s_ = 0.0;    // largest nodal speed relative to the mean velocity
  double give_J_ = 0.0;          // elastic energy of the contacts
  bool alone_ = false;           // at most one hold, and nothing that holds or touches the thread moves (glossary)
  bool faded_ = false;           // the remeshing offsets have already been reduced for the next tick
  double kept_J_ = 0.0;          // alone only: total energy at the end of the last tick
  bool measured_ = false;        // contact detection of this substep is complete
  double since_look_s_ = 0.0;    // time moved since contacts were detected
  std::vector<Vec> v_before_;    // velocities at the start of the substep
  bool labours_ = false;         // the last tick used most of its budget, so this one has fewer substeps
  bool letting_go_ = false;      // a hold was released, and the thread is still fast
  Motion motion_;
  ContactReport seen_;          // result of the contact solver in this substep
  double near_m_ = 0.0;         // gap below which a pair is a contact at any speed
  double horizon_s_ = 0.0;      // time for which the list of pairs is valid if speeds stay as when it was built
  double tick_travel_m_ = 0.0;  // upper bound of any node's travel since the tick began
  int substep_index_ = 0;
  bool mesh_held_ = false;
  bool remeshed_ = false;  // nodes moved along the thread since spin_ was last updated
  bool released_ = false;  // a hold was released since the last tick
  bool stale_ = true;      // the list of pairs must be rebuilt
};

}  // namespace ligature::physics::rod
