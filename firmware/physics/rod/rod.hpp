#pragma once
// A rod in its world: the parts together, and the list of verbs that is a tick.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "firmware/physics/rod/assembly.hpp"
#include "firmware/physics/rod/contact.hpp"
#include "firmware/physics/rod/refine.hpp"
#include "firmware/physics/rod/twist.hpp"

namespace ligature::physics::rod {

/// What a scene models. Each combination is its own compiled substep; what is absent is not executed.
struct Parts {
  bool twist = true;
  bool contact = true;  ///< of the thread with itself
  bool friction = true;
  bool world = false;     ///< floor and bodies
  bool adaptive = false;  ///< nodes move along the thread to where they are needed
  bool roll = false;      ///< every segment rolls by itself (spin.hpp): needs twist
  bool turning = false;   ///< friction turns the thread: needs roll and friction
  bool set = false;       ///< sharp bends stay (spin_set.cpp): needs twist

  /// Does every segment have a frame of its own? With `roll` they turn in every substep, else once a tick.
  [[nodiscard]] constexpr bool frames() const noexcept { return roll || set; }
};

/// What a tick did. Plain values.
struct TickReport {
  int substeps = 0, passes = 0, contacts = 0, guard_events = 0, broad_phases = 0, remeshes = 0;
  double min_gap_m = 1e9;  ///< smallest thread-thread gap in any substep; negative: overlap
  long work = 0;           ///< spent on contact, of Numerics::budget()

  double set_J = 0.0;  ///< lost in bends that set

  // What was given up, in this order.
  int cut_short = 0;       ///< substeps whose contacts used up their passes before they settled
  int rows_left_out = 0;   ///< contacts that were only guarded, at most in a substep
  double time_lost = 0.0;  ///< share of the tick in which the thread was not moved: nobody knew whether it could be
  int cut_at = -1;         ///< question at which the tick's time was over (time_left.hpp); -1: it was not
};

/// A rod. Build it, place it with state(), then tick. Only the constructor allocates. Copyable: all of its state goes
/// along; the list of pairs and the matrices of contact are made anew, for reset() copies in the loop and they are
/// large.
class Rod {
 public:
  /// @param n nodes, >= 3, equally spaced to begin with; straight along +x from the origin, at rest.
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
  [[nodiscard]] const Spin& spin() const noexcept { return spin_; }  ///< with Parts::frames()
  [[nodiscard]] double twist_energy_J() const noexcept {
    return parts_.frames() ? spin_.energy_J(material_, state_) : twist_.energy_J();
  }
  [[nodiscard]] const Forces& forces() const noexcept { return forces_; }
  [[nodiscard]] const ContactSet& contact_set() const noexcept { return contacts_; }

  /// Where nodes move: lays them out anew for a thread curved so at places equally far apart along it. For a rod that
  /// has not moved yet; positions are the caller's, from state().mesh.s.
  void spread(std::span<const double> curvature_per_m);

  /// After positions, clamps or spacing were changed from outside: constants of the mesh again, contacts forgotten, the
  /// thread without twist where every segment rolls by itself.
  void moved() noexcept;

  /// The motion, holds and twist of another rod, with this one's material. @return false, and nothing done, when it has
  /// another number of nodes. No allocation.
  [[nodiscard]] bool continue_from(const Rod& other) noexcept;

  /// Holds a node: rigidly at p, m; rigidly with the unit tangent along `direction` and the roll; or by a hand at
  /// `tool`, f = K (tool - x) + B (v_tool - v) on the node, implicit, with the roll and (directed) the tangent that it
  /// has now. @return index of the hold, -1 when kMaxHolds hold already. O(1) but with a direction: O(n), no
  /// allocation.
  int support(int node, Vec p) noexcept;
  int clamp(int node, Vec p, Vec direction) noexcept;
  int grip(int node, double stiffness_N_per_m, double damping_N_s_per_m, Vec tool, bool holds_roll = true,
           bool directed = false) noexcept;
  /// Lets go: the next tick may have more substeps for what that throws. @pre an index that one of the above returned.
  void release(int hold) noexcept;

  /// Advances by numerics().tick_s. `goals` are the hold targets at the end of the tick, m (unmoved holds: their
  /// target). Without error: what could not be done is in report(). Costs O(n) a substep and at most
  /// Numerics::budget() instructions on contact; no allocation, no exception. When the time left does not do, the
  /// thread stands still for the rest of the tick, as it does when the work is spent.
  void tick(const std::array<Vec, kMaxHolds>& goals, const TimeLeft& left = {}) noexcept;
  void tick() noexcept;
  /// All that the tick is for has been done: how long that took after the last question is for the next tick to know.
  void tick_ended() noexcept { work_.time().end(); }

  /// The first verb of a tick, on its own: nodes move along the thread. @return true when some did.
  bool remesh() noexcept;
  /// A hand that holds roll and turns the thread: from the next tick on the hold's director is along `steer`, and with
  /// a directed hold its tangent along `direction`.
  void steer(int hold, Vec steer, Vec direction) noexcept;
  /// Keeps tick() from moving nodes along the thread, until told otherwise. For those who call remesh() themselves.
  void hold_mesh(bool on) noexcept { mesh_held_ = on; }

  [[nodiscard]] const TickReport& report() const noexcept { return report_; }
  /// The give of contacts is that at the end of the last tick; without twist_energy_J().
  [[nodiscard]] Energy energy() const noexcept {
    Energy e = rod::energy(material_, state_, gravity);
    e.give_J = give_J_;
    return e;
  }
  /// All of energy(), of twist, of the holds' springs and of the constant loads.
  [[nodiscard]] double all_J(const Energy& e) const noexcept;

 private:
  using Substep = bool (Rod::*)(double) noexcept;
  static Substep pick(const Parts& parts) noexcept;
  /// @return false, and nothing moved, when the work left does not do for it.
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
  /// Newton's method is for the jams of knots; where the thread lies on something, sweeps do.
  [[nodiscard]] bool solves_directly() const noexcept { return !parts_.turning && contacts_.only_pairs(); }
  struct Allowance {
    long window, rows, passes;  // nodes; work for rows with the least passes; work for rows with all passes
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
  static constexpr double kPatience = 12.0;  ///< ticks in which a substep may wait to be solved, and guarded, at most
  [[nodiscard]] bool can_wait() const noexcept { return solves_directly() && waits_ + 1 <= patience_; }
  bool put_off() noexcept;
  bool give_up() noexcept;
  double brake(double dt_s) noexcept;

  /// Of the holds: the fastest, and how fast two of them part (or one drags the thread), m/s.
  struct HandSpeed {
    double fastest = 0.0, apart = 0.0;
    int holds = 0;
  };
  HandSpeed set_hands(const std::array<Vec, kMaxHolds>& goals, std::array<Vec, kMaxHolds>& starts) noexcept;
  void begin_tick(const HandSpeed& hands, const TimeLeft& left) noexcept;
  /// Forces on the hands where the thread will be in `ahead_s`.
  void feel_hands(double ahead_s) noexcept;
  int add_hold(const Hold& hold) noexcept;
  /// What remeshing left, of bends, strains and corners, fades.
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
  long look_cost_ = 0, rows_cost_ = 0;  // of the last substep
  long list_cost_ = 0;                  // of the last list
  double metric_dt_ = 0.0;
  double pace_m_per_s_ = 0.0;    // of the hands from the middle between them, fading once they stop
  double leniency_ = 1.0;        // how much less a pass need settle, since ticks' work did not do for all passes
  bool braked_ = false;          // the last substep was slowed; what hands felt is known
  int waits_ = 0;                // ticks in which the work ran out before the next substep was done
  double patience_ = kPatience;  // how many it may wait: less where substeps waited in vain, more where they settle
  bool sweeps_only_ = false;     // the next substep is done without Newton's method
  double stir_m_per_s_ = 0.0;    // how fast the fastest node moves among the others
  double give_J_ = 0.0;          // stored in contacts
  bool alone_ = false;           // nothing that holds or touches it moves in this tick, and one hold at most holds it
  bool faded_ = false;           // what remeshing left has faded for the tick to come
  double kept_J_ = 0.0;          // of a thread that is alone: what the last tick left it
  bool measured_ = false;        // all of them are known, from before the last move
  double since_look_s_ = 0.0;    // how long that was
  std::vector<Vec> v_before_;    // the substep's first velocities
  bool labours_ = false;         // the work hardly did for the last tick, so this one has fewer substeps
  bool letting_go_ = false;      // a hold let go, and what it threw still flies
  Motion motion_;
  ContactReport seen_;          // of this substep
  double near_m_ = 0.0;         // within which a pair is a contact at any speed
  double horizon_s_ = 0.0;      // how far the list of pairs looks ahead
  double tick_travel_m_ = 0.0;  // what the fastest node may have gone since the tick began
  int substep_index_ = 0;
  bool mesh_held_ = false;
  bool remeshed_ = false;  // nodes moved since the spin was last brought along
  bool released_ = false;  // a hold let go since the last tick
  bool stale_ = true;      // the list must be made again
};

}  // namespace ligature::physics::rod
