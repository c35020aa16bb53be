#pragma once
// Contacts of the thread with itself and with fixed bodies, solved together with the rod in every substep.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "firmware/physics/rod/band_solver.hpp"
#include "firmware/physics/rod/broad_phase.hpp"
#include "firmware/physics/rod/contact_metric.hpp"
#include "firmware/physics/rod/contact_newton.hpp"
#include "firmware/physics/rod/mixing.hpp"
#include "firmware/physics/rod/swept.hpp"
#include "firmware/physics/rod/turning.hpp"
#include "firmware/physics/rod/work.hpp"

namespace ligature::physics::rod {

/// A rigid capsule in the world: a peg, or a gripper's jaw. An infinite plane is a `floor_m`.
struct Body {
  Vec p0{}, p1{};  ///< axis, m
  double radius_m = 0.0;
  Vec velocity{};
  double friction = 0.3;
};

/// One touching pair. The relative point velocity is u = sum_k w_k v[node_k] - surface; the impulse p acts on node k as
/// w_k p. Of the thread with itself: first the nodes of the two segments, then the others that the points of the smooth
/// curves depend on (smooth.hpp).
struct Contact {
  static constexpr int kMostNodes = ContactNewton::kMostNodes;
  std::int32_t node[kMostNodes] = {};
  double w[kMostNodes] = {};
  Vec n{};                  ///< unit normal, direction of a separating u
  Vec surface{};            ///< velocity of the body's surface, m/s
  Vec p{};                  ///< impulse, N s; p . n >= 0
  Vec u_free{};             ///< u without any impulse
  double gap_m = 0.0;       ///< surface distance, negative: overlap
  double target = 0.0;      ///< least normal velocity, m/s
  double inv_w = 0.0;       ///< 1 / (J C^-1 J^T)
  double soft = 0.0;        ///< give of the normal: u_n + soft p_n >= target, 1/kg
  double inv_soft_w = 0.0;  ///< 1 / (J C^-1 J^T + soft)
  double mu = 0.0;
  std::int32_t first = 0, last = 0;     ///< lowest and highest of the nodes
  std::int32_t count = 4;               ///< nodes in use
  double reach_m = 0.0;                 ///< centre distance at which the pair touches
  double distance_m = 0.0;              ///< of the chords, for the guard
  bool loaded = false;                  ///< has carried an impulse in this substep
  Vec* keep = nullptr;                  ///< where the impulse is kept between substeps
  Candidate* pair = nullptr;            ///< of the thread with itself
  char* stuck = nullptr;                ///< where it is kept whether friction held
  std::int32_t place[kMostNodes] = {};  ///< of the nodes in SweptVelocities
  float weight[kMostNodes] = {};        ///< w for it

  [[nodiscard]] bool is_pair() const noexcept { return count >= 4; }
};

/// What happened in a substep or, summed by the caller, in a tick.
struct ContactReport {
  int passes = 0;
  long work = 0;                ///< of the passes
  bool cut_short = false;       ///< they ended before the contacts had settled
  double change_m_per_s = 0.0;  ///< of a velocity in the last pass, or more
  double min_gap_m = 1e9;       ///< of thread-thread contacts before the substep
  int rows_left_out = 0;        ///< contacts that were only guarded: no room, or no work left for them
};

/// How hard the contacts of a substep are worked on.
struct Effort {
  TickTime& time;
  int passes = 0;                ///< at most
  long work = 0;                 ///< for all of them, in instructions (work.hpp); the first pass is always done
  double settled_m_per_s = 0.0;  ///< a pass that changes no velocity by more is the last
  double enough_m_per_s = 0.0;   ///< what Newton's method may leave over beyond its fair share of the work
  long fair = 0;                 ///< that share
};

/// Of settle_directly().
enum class Outcome : std::uint8_t {
  kSettled,
  kLater,     ///< the work ran out: the same substep, done again, goes on from there
  kUnsolved,  ///< too much for Newton's method, or it found no answer: sweeps are for it
};

inline constexpr int kMaxContacts = 768;  ///< rows that can be solved at once

/// Contacts of one rod. Collect, choose rows, then settle; everything is preallocated, and every step says what it
/// spends (work.hpp). What is collected but not chosen feels no impulse, but the guard holds it.
///
/// A contact wants u_n >= -gap / dt when apart (nothing before they meet), u_n >= min(-beta gap / dt, limit) when
/// overlapping, and u_t = 0 with |p_t| <= mu p_n: true static friction, no slip tolerance. With a static coefficient of
/// its own (let_stick()), mu is that of sticking as long as the contact held in the last substep.
///
/// settle(): p and v start from the last substep's impulses. Each pass runs one projected Gauss-Seidel sweep in the
/// metric C (contact_metric.hpp), then pushes the change of p through the true matrix A; passes are mixed (mixing.hpp),
/// because C knows nothing of stretch and alone would need hundreds along the thread's axis. It ends when no velocity
/// changes by more than `settled_m_per_s`, or after `passes`. Each pass costs the contact window alone.
class ContactSet {
 public:
  ContactSet() = default;
  ContactSet(const ContactSet& other) = delete;  // contacts point into the lists
  /// Impulses, pairs and the contacts of the last substep, which remeshing asks for; what is known of the matrix is not
  /// copied, nor where a contact's impulse is kept. @pre both reserved alike, or other is larger.
  ContactSet& operator=(const ContactSet& other);
  ContactSet(ContactSet&&) noexcept = default;
  ContactSet& operator=(ContactSet&&) noexcept = default;
  ~ContactSet() = default;

  void reserve(int nodes, int bodies, int window);
  /// For settle<.., true>.
  void reserve_turning() { turning_.reserve(kMaxContacts); }

  /// Watched thread-thread pairs; rebuilt by BroadPhase.
  std::vector<Candidate> pairs;
  std::vector<PairGroup> groups;

  void begin() noexcept { contacts_.clear(), watched_.clear(), rows_ = 0, overflow_ = false; }

  /// Measures pairs that may have come within their near_m + 2 dt x their rate (motion.hpp); those within near_m + 2 dt
  /// x relative speed become contacts. @return false when there is not work enough left to measure them all.
  [[nodiscard]] bool collect_thread(const State& state, const Motion& motion, double dt_s, double mu, Work& work,
                                    ContactReport& report) noexcept;
  /// Every node against the plane z = floor_m.
  void collect_floor(const State& state, double floor_m, double radius_m, double look_m, double mu,
                     Work& work) noexcept;
  /// Every segment against a capsule; not even looked at while the thread, travel_m on its way in this tick, cannot
  /// have reached it.
  void collect_body(const State& state, const Body& body, int index, double radius_m, double look_m, double travel_m,
                    Work& work) noexcept;
  /// Bodies may have moved: look at each again.
  void forget_bodies() noexcept { std::fill(body_due_.begin(), body_due_.end(), -1.0); }

  /// Does the work left do for the floor and all bodies, wherever the thread is?
  [[nodiscard]] static bool afford_world(int nodes, int bodies, const Work& work) noexcept;

  /// Nodes of everything collected; last < first when nothing was.
  struct Span {
    int first, last;
  };
  [[nodiscard]] Span span() const noexcept;
  /// Does the thread touch nothing but itself?
  [[nodiscard]] bool only_pairs() const noexcept {
    return std::all_of(contacts_.begin(), contacts_.end(), [](const Contact& c) { return c.is_pair(); });
  }

  /// Decides which contacts are solved: the `most` deepest, on a window of at most `widest` nodes. @pre nodes >= 2.
  void choose_rows(int most, int widest, int nodes, ContactReport& report) noexcept;

  /// Contacts that held in the last substep, and new ones that begin at rest, may be held by mu_static.
  void let_stick(double mu_static, const Vec* v) noexcept;

  [[nodiscard]] int rows() const noexcept { return rows_; }  ///< 0: nothing to settle
  [[nodiscard]] int window_first() const noexcept { return window_first_; }
  [[nodiscard]] int window_last() const noexcept { return window_last_; }

  /// First of all: what rows want, and the window's velocities v with the impulses of the last substep. @pre rows() >
  /// 0, the solver's core lies in the window. Turns: segments turn too; turn_with() was called.
  template <bool Turns>
  void start(BandSolver& solver, const Numerics& numerics, double dt_s, Vec* v) noexcept;

  /// Solves for v by Newton's method (contact_newton.hpp). Not settled: impulses and v as after start().
  template <bool Friction>
  Outcome settle_directly(BandSolver& solver, const Effort& effort, Vec* v, ContactReport& report) noexcept;
  /// What settle_directly() knows of the matrix is of another mesh or time step.
  void forget_matrix() noexcept { newton_.forget(); }

  /// Solves for the window's velocities v with all rows. @pre rows() > 0, the solver's core lies in the window, the
  /// metric covers it. Turns: segments turn too; turn_with() was called. @return false, and nothing is solved, when the
  /// time was over before the first pass.
  template <bool Friction, bool Turns>
  [[nodiscard]] bool settle(BandSolver& solver, const ContactMetric& metric, const Effort& effort, Vec* v,
              ContactReport& report) noexcept;
  void turn_with(Spin& spin, int segments, double radius_m) noexcept {
    spin_ = &spin, segments_ = segments, radius_m_ = radius_m;
  }

  /// After nodes moved along the thread: pairs with an impulse find their segments again by material coordinate.
  void relabel(const std::vector<double>& s) noexcept;

  /// What the give of contacts stores, 1/2 k overlap^2 each, J, where the velocities v lead in step_s.
  [[nodiscard]] double give_J(double k_N_per_m, const Vec* v, double step_s) const noexcept;

  /// Turns impulses of the last substep into forces, 1/s.
  [[nodiscard]] double per_second() const noexcept { return per_second_; }

  /// Keeps the impulses for the next substep.
  void store() noexcept;
  /// Which contacts hold at the velocities solved for, for let_stick().
  template <bool Turns>
  void note_stuck(const Vec* v) noexcept;

  /// Largest alpha <= 1 with which no measured pair moves by more than 0.9 of its centre distance; 0 when there was no
  /// room to note all that is near.
  [[nodiscard]] double safe_fraction(const Motion& motion, const State& state, double dt_s) const noexcept;

  /// After a substep whose contacts did not settle: largest alpha <= 1 with which no row begins to overlap, or overlaps
  /// by hardly more than it did. Else a jam would burst within a few substeps; so it waits.
  [[nodiscard]] double unsettled_fraction(const Vec* v, double dt_s) const noexcept;

  /// The same for every pair on the list, by the least distance it can have: what it had when last measured, less what
  /// it may have gone since.
  [[nodiscard]] double safe_fraction_of_pairs(const Motion& motion, const State& state, double dt_s) const noexcept;

  [[nodiscard]] const std::vector<Contact>& contacts() const noexcept { return contacts_; }

  std::vector<Vec> floor_impulse;  ///< per node
  std::vector<Vec> body_impulse;   ///< per body and segment
  std::vector<char> floor_stuck, body_stuck;

 private:
  [[nodiscard]] Contact* add() noexcept;
  [[nodiscard]] bool find_due(const Motion& motion, double dt_s, Work& work) noexcept;
  /// What is known of a pair that was measured.
  struct Measured {
    Vec between;                       ///< from the closest point of the first to that of the second, m
    double s, t, distance_m, chord_m;  ///< where; how far apart; how far the chords are
    bool smooth;                       ///< between smooth curves
  };
  template <bool Smooth>
  void measure(const std::int32_t* places, const State& state) noexcept;
  void bend(const State& state) noexcept;
  void bend_row(Contact& c, int at, double s, const State& state) const noexcept;
  /// @return true when it became a contact.
  bool take(Candidate& pair, const Measured& measured, const State& state, const Motion& motion, double dt_s, double mu,
            ContactReport& report) noexcept;
  [[nodiscard]] bool make_columns(const ContactMetric& metric, TickTime& time) noexcept;
  void make_column(Contact& c, const ContactMetric& metric, float* column) const noexcept;
  [[nodiscard]] Contact& loaded(std::size_t k) noexcept { return contacts_[static_cast<std::size_t>(loaded_[k])]; }
  /// @return the square of the largest step of a velocity, or more.
  template <bool Friction, bool Turns>
  double plain_pass(BandSolver& solver, Vec* v, TickTime& time) noexcept;
  template <bool Turns>
  void mix(BandSolver& solver, Vec* v) noexcept;
  template <bool Turns>
  [[nodiscard]] double merit(const Vec* v) const noexcept;
  /// Relative velocity of row k.
  template <bool Turns>
  [[nodiscard]] Vec velocity(int k, const Vec* v) const noexcept;
  [[nodiscard]] static Vec velocity(const Contact& c, const Vec* v) noexcept {
    Vec u = -c.surface;
    for (int j = 0; j < c.count; ++j) u += c.w[j] * v[c.node[j]];
    return u;
  }
  /// v += A^-1 extra_ on the window. @return the sum over axes of the largest squares of that step.
  double push(BandSolver& solver, Vec* v) noexcept;
  void clear_extra() noexcept;
  template <bool Friction, bool Turns>
  void sweep(const Vec* v, TickTime& time) noexcept;
  /// Newton's method in a substep: what it may do, and how far it is.
  struct Search {
    const Effort& effort;
    ContactReport& report;
    long nodes;  ///< of the window
    int look = 0;
    bool fresh = false, resumed = false;  ///< the matrix is today's; it goes on from where the last tick was
    [[nodiscard]] bool can_pay(long cost) const noexcept { return report.work + cost <= effort.work; }
    [[nodiscard]] bool pay(long cost) noexcept {
      return can_pay(cost) && effort.time.allows() && ((report.work += cost), true);
    }
  };
  bool renew_matrix(const BandSolver& solver, Search& search) noexcept;
  Outcome look_at_all(const BandSolver& solver, const Vec* v, Search& search) noexcept;
  template <bool Friction>
  std::optional<Outcome> step_on(Search& search) noexcept;
  template <bool Friction>
  Outcome newton_steps(BandSolver& solver, const Effort& effort, Vec* v, ContactReport& report) noexcept;
  void take_impulses(BandSolver& solver, Vec* v) noexcept;

  /// A pair that is near but no contact in this substep; only the guard looks at it again.
  struct Watched {
    std::int32_t a, b;
    double distance_m;
  };

  std::vector<Contact> contacts_;  // rows first, then what is left out
  std::vector<Watched> watched_;
  std::vector<std::int32_t> awake_, due_;  // groups, and pairs, to look at in this substep
  std::vector<std::int32_t> close_, far_;  // places in due_: those to measure between smooth curves, and the others
  std::vector<Measured> measured_;         // like due_
  std::vector<Vec> corner_;                // of the smooth curve, at the nodes of bent_
  std::vector<double> share_;              // of a corner that is cut: 1, or less where that would be too much
  Span bent_{0, -1};                       // of close pairs
  std::vector<double> gaps_;               // scratch of choose_rows()
  std::vector<float> columns_;             // C^-1 J^T of every row on the window, padded
  SweptVelocities swept_;
  std::vector<Vec> extra_, step_;
  std::vector<std::int32_t> loaded_;  // rows that have carried an impulse in this substep: the others are not mixed
  std::vector<Vec> p_, plain_, residual_;  // their impulses and their change in a pass, as the mixing wants them
  Mixing mixing_;
  ContactNewton newton_;
  std::vector<Vec> u_, v_start_, p_start_;
  double start_error2_ = 0.0;  // with the impulses of the last substep, (m/s)^2
  Turning turning_;
  Spin* spin_ = nullptr;
  int segments_ = 0;
  double radius_m_ = 0.0;
  std::vector<double> body_due_;  // least gap of a body when last measured + travel then
  std::size_t stride_ = 0;
  double per_second_ = 0.0;
  int rows_ = 0, window_first_ = 0, window_last_ = 1;
  bool overflow_ = false;
};

/// The impulse of Coulomb's cone about n, half-angle atan(mu), that has p's normal part and is nearest to it.
[[nodiscard]] inline Vec in_cone(Vec p, Vec n, double mu) noexcept {
  const double pn = dot(p, n);
  if (pn <= 0.0) return Vec{};
  const Vec pt = p - pn * n;
  const double size2 = dot(pt, pt), most = mu * pn;
  return pn * n + (size2 > most * most ? most / std::sqrt(size2) : 1.0) * pt;
}

template <bool Turns>
Vec ContactSet::velocity(int k, const Vec* v) const noexcept {
  Vec u = velocity(contacts_[static_cast<std::size_t>(k)], v);
  if constexpr (Turns) u += turning_.slip(k);
  return u;
}

}  // namespace ligature::physics::rod
