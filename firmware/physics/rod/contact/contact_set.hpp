#pragma once
// Contacts of the thread with itself and with bodies. They are solved together with the rod's equations in every
// substep.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "firmware/physics/rod/contact/contact_memory.hpp"
#include "firmware/physics/rod/contact/contact_metric.hpp"
#include "firmware/physics/rod/contact/pair_search.hpp"
#include "firmware/physics/rod/contact/turning.hpp"
#include "firmware/physics/rod/solve/band_solver.hpp"
#include "firmware/physics/rod/solve/contact_newton.hpp"
#include "firmware/physics/rod/solve/mixing.hpp"
#include "firmware/physics/rod/solve/node_velocities.hpp"
#include "firmware/physics/rod/work.hpp"

namespace ligature::physics::rod {

/// Result of the contact solver in one substep.
struct ContactReport {
  int passes = 0;
  long work = 0;                ///< work of the passes, in instructions
  bool cut_short = false;       ///< the solver stopped before it converged
  double change_m_per_s = 0.0;  ///< upper bound of the velocity change in the last pass (Newton: of the error)
  double min_gap_m = 1e9;       ///< smallest thread-thread gap before the substep
  int rows_left_out = 0;        ///< contacts not solved for lack of room or work; only the guard separates them
};

/// Limits and tolerances of the contact solver in one substep.
struct Effort {
  TickTime& time;
  int passes = 0;                ///< most passes
  long work = 0;                 ///< most work for all passes, in instructions (work.hpp); one pass is always done
  double settled_m_per_s = 0.0;  ///< tolerance: a pass that changes no velocity by more is the last
  double enough_m_per_s = 0.0;   ///< newton_near times this ends Newton's method once it used more work than `fair`
  long fair = 0;                 ///< work per substep if the rest of the tick's work is shared out equally
};

/// Result of Newton's method in a substep (ContactSet::settle_directly()).
enum class Outcome : std::uint8_t {
  kSettled,   ///< converged, or accepted with the looser tolerance (not counted as cut short)
  kLater,     ///< work or time ran out: repeating the substep continues from the impulses found so far
  kUnsolved,  ///< system too large for Newton's method, or no convergence: use the sweep solver
};

inline constexpr int kMaxContacts = 768;  ///< rows that can be solved at once

/// Data that a ContactSet computes again in every substep, and the state of Newton's method, which lasts longer.
class ContactWork {
 public:
  /// From the first to the last node of all collected contacts; last < first if there are none.
  struct Span {
    int first, last;
  };
  /// The members that an image saves (image.hpp): all but those that each substep computes again.
  [[nodiscard]] static auto members(ContactWork& self) noexcept {
    auto& [watched, awake, due, close, far, measured, near, heads, bins, corner, share, bent, gaps, columns, swept,
           extra, step, loaded, p, plain, residual, mixing, newton, u, v_start, p_start, turning, body_due, stride,
           first, last, overflow] = self;
    return std::tie(newton, body_due, first, last, overflow);
  }

 protected:
  /// Closest points of a pair of segments.
  struct Measured {
    Vec between;                       ///< from the point on the first segment to that on the second, m
    double s, t, distance_m, chord_m;  ///< parameters of the points; their distance; distance of the chords
    bool smooth;                       ///< points of the smooth curves, not of the chords
    bool touches = false;              ///< is to become a contact
  };
  /// A measured pair that is near enough to be a contact.
  struct Near {
    std::int32_t due, next;  ///< its index in due_; the next one in the list of a bin (heads_), or -1
    double gap_m, a, b;      ///< gap by which it is ordered; material coordinates of its points, m
    bool loaded;             ///< carried an impulse in the last substep
  };
  /// A near pair that is no contact in this substep. After this only the guard reads it (guard.cpp): it checks that the
  /// pair does not cross within the substep.
  struct Watched {
    std::int32_t a, b;
    double distance_m;
  };

  std::vector<Watched> watched_;
  std::vector<std::int32_t> awake_, due_;  // indices of the groups and pairs that must be measured in this substep
  std::vector<std::int32_t> close_, far_;  // indices into due_: measured between smooth curves; between chords only
  std::vector<Measured> measured_;         // in the order of due_
  std::vector<Near> near_;                 // pairs that are near enough to be contacts
  static constexpr std::size_t kBinsPerNode = 8;  // at most
  std::vector<std::int32_t> heads_;  // per bin of the thread: first contact in near_ with its point a in it, or -1
  double bins_per_m_ = 0.0;          // all bins together are as long as the thread
  std::vector<Vec> corner_;          // corner vectors k_i of the smooth curve (smooth.hpp) at nodes
  std::vector<double> share_;        // per node: factor <= 1 by which k_i is reduced to limit the corner's cut
  Span bent_{0, -1};                 // nodes from the first to the last of the pairs in close_
  std::vector<double> gaps_;         // scratch of choose_rows()
  Floats columns_;                   // per row: C^-1 J^T, velocity of each window node per impulse; padded
  SweptVelocities swept_;
  std::vector<Vec> extra_, step_;
  std::vector<std::int32_t> loaded_;  // rows that have carried an impulse in this substep; only these are mixed
  // Impulses. In sweeps, in the order of loaded_: p_ after mixing, plain_ before mixing, residual_ their change in a
  // pass. In Newton's method, by row: p_ the present ones, plain_ the best so far
  std::vector<Vec> p_, plain_, residual_;
  Mixing mixing_;
  ContactNewton newton_;
  std::vector<Vec> u_, v_start_, p_start_;
  Turning turning_;
  std::vector<double> body_due_;  // per body: last measured gap + the thread's travel at that time
  std::size_t stride_ = 0;
  int window_first_ = 0, window_last_ = 1;
  bool overflow_ = false;
};

/// Contacts of one rod. Collect them, choose which become rows of the system, then solve. All memory is preallocated,
/// and every step charges its work to the budget (work.hpp). A contact that is collected but not chosen gets no
/// impulse; only the guard keeps it from passing through.
///
/// Conditions of a contact. u: relative velocity, p: impulse, u_n, p_n: their parts along the normal, u_t, p_t: their
/// parts across it, dt: time step, mu: friction coefficient, beta: share of an overlap that a step removes.
///   p_n >= 0 and u_n + c p_n >= target, one of them an equality:  c = beta / (k dt^2), k: stiffness of the contact,
///   target = -gap / dt while apart, -beta gap / dt while overlapping
///   u_t = 0 unless |p_t| = mu p_n
/// This is exact Coulomb friction, without a slip tolerance. With a separate static coefficient (let_stick()), mu is
/// the static one as long as the contact slid by less than tuning.settled_m_per_s in the last substep.
///
/// settle() starts from the impulses of the last substep. Each pass is one projected Gauss-Seidel sweep with the
/// simplified matrix C (contact_metric.hpp); then the change of p is applied with the full matrix A. C lacks the
/// stretch terms, so without Anderson mixing (mixing.hpp) hundreds of passes would be needed along the thread's axis.
/// settle() ends when a pass changes no velocity by more than `settled_m_per_s`, or after `passes`.
///
/// The window is the range of nodes from the first to the last on which any row acts. Only the window's velocities are
/// solved with contacts, so a pass costs in proportion to rows x nodes of the window, not of the whole thread.
class ContactSet : public ContactMemory, public ContactWork {
 public:
  ContactSet() = default;
  ContactSet(const ContactSet& other) = delete;  // a copied vector has no spare capacity: reserve(), then assign
  /// Copies only the ContactMemory, because everything else is found again in the next substep. @pre both objects were
  /// reserved with equal sizes.
  ContactSet& operator=(const ContactSet& other);
  ContactSet(ContactSet&&) noexcept = default;
  ContactSet& operator=(ContactSet&&) noexcept = default;
  ~ContactSet() = default;

  [[nodiscard]] static auto members(ContactSet& self) noexcept {
    return std::tie(static_cast<ContactMemory&>(self), static_cast<ContactWork&>(self));
  }

  void reserve(int nodes, int bodies, int window);
  /// Allocates memory for friction that rolls the thread. Call before any function below with `Turns`.
  void reserve_turning() { turning_.reserve(kMaxContacts); }

  void begin() noexcept { contacts_.clear(), watched_.clear(), rows_ = 0, overflow_ = false; }

  /// Measures every listed pair whose gap may be below near_m + 2 dt x the upper bound of its relative speed
  /// (Motion::rate()). Pairs whose gap is below near_m + 2 dt x the actual relative speed become contacts, except those
  /// that choose_near() leaves out. @return false if the work or time left is too small for all pairs.
  [[nodiscard]] bool collect_thread(const State& state, const Motion& motion, double dt_s, double mu, Work& work,
                                    ContactReport& report) noexcept;
  /// Collects the contacts between nodes and the plane z = floor_m whose gap is below look_m.
  void collect_floor(const State& state, double floor_m, double radius_m, double look_m, double mu,
                     Work& work) noexcept;
  /// Collects the contacts between segments and a capsule whose gap is below look_m. Skips the capsule as
  /// long as no node can have reached it, even if every node has moved by travel_m in this tick. `Drum`: adds the
  /// motion of a surface that turns (Body::spin).
  template <bool Drum>
  void collect_body(const State& state, const Body& body, int index, double radius_m, double look_m, double travel_m,
                    Work& work) noexcept;
  /// Call when bodies may have moved. The next collect_body() then measures each body again.
  void forget_bodies() noexcept { std::fill(body_due_.begin(), body_due_.end(), -1.0); }

  /// Is the work left enough to check floor and all bodies, in the worst case?
  [[nodiscard]] static bool afford_world(int nodes, int bodies, const Work& work) noexcept;

  [[nodiscard]] Span span() const noexcept;
  /// Are all contacts those of the thread with itself?
  [[nodiscard]] bool only_pairs() const noexcept {
    return std::all_of(contacts_.begin(), contacts_.end(), [](const Contact& c) { return c.is_pair(); });
  }

  /// Chooses the contacts to be solved (rows): at most `most`, first those with an impulse, then those with the
  /// smallest gap, and only if all of them act within a range of `widest` nodes. @pre nodes >= 2.
  void choose_rows(int most, int widest, int nodes, ContactReport& report) noexcept;

  /// Gives the friction coefficient mu_static to contacts that did not slide in the last substep, and to new contacts
  /// that do not slip at the velocities v.
  void let_stick(double mu_static, const Vec* v) noexcept;

  [[nodiscard]] int rows() const noexcept { return rows_; }  ///< number of contacts to be solved
  /// First and last node on which the chosen contacts act.
  [[nodiscard]] int window_first() const noexcept { return window_first_; }
  [[nodiscard]] int window_last() const noexcept { return window_last_; }

  /// First step of the solution: computes the target velocities of all rows, and the velocities v of the window's nodes
  /// with the impulses of the last substep. `Turns`: friction also rolls the segments about their axes; call
  /// turn_with() before.
  /// @pre rows() > 0; the window contains the solver's two core nodes.
  template <bool Turns>
  void start(BandSolver& solver, const Numerics& numerics, double dt_s, Vec* v) noexcept;

  /// Solves for the velocities v of the window's nodes by Newton's method (contact_newton.hpp). If the method does not
  /// converge, impulses and v are as after start().
  template <bool Friction>
  Outcome settle_directly(BandSolver& solver, const Effort& effort, Vec* v, ContactReport& report) noexcept;
  /// Call when mesh or time step have changed. settle_directly() then computes the inverse matrix again.
  void forget_matrix() noexcept { newton_.forget(); }

  /// Solves for the velocities v of the window's nodes by sweeps. Turns: friction also rolls the segments.
  /// @pre rows() > 0; the window contains the solver's two core nodes; `metric` was computed for all nodes of the
  /// window.
  /// @return false if the time was over before the first pass; then nothing is solved.
  template <bool Friction, bool Turns>
  [[nodiscard]] bool settle(BandSolver& solver, const ContactMetric& metric, const Effort& effort, Vec* v,
                            ContactReport& report) noexcept;
  /// Call after choose_rows().
  void turn_with(Spin& spin, int segments, double radius_m) noexcept {
    turning_.prepare(contacts_.data(), rows_, segments, radius_m, spin);
  }

  /// Call after remeshing: pairs with an impulse move to the segments that now contain their material coordinates.
  void relabel(const std::vector<double>& s) noexcept;

  /// Elastic energy of the contacts, J: the sum of 1/2 k overlap^2, with the contact stiffness k. Overlaps are
  /// extrapolated by the time step_s at the velocities v.
  [[nodiscard]] double give_J(double k_N_per_m, const Vec* v, double step_s) const noexcept;

  /// Factor, 1/s, that converts impulses of the last substep to forces: the inverse of its time step.
  [[nodiscard]] double per_second() const noexcept { return per_second_; }

  /// Stores the impulses for the next substep.
  void store() noexcept;
  /// Notes for let_stick() in the next substep which contacts stick at the velocities v.
  template <bool Turns>
  void note_stuck(const Vec* v) noexcept;

  /// The guard: largest alpha <= 1 such that in a step of alpha dt_s the segments of no measured pair move, relative to
  /// each other, by more than 0.9 of their distance. 0 if not all near pairs could be stored.
  [[nodiscard]] double safe_fraction(const Motion& motion, const State& state, double dt_s) const noexcept;

  /// The brake for velocities that did not converge: largest alpha <= 1 such that the velocities alpha v make no row
  /// overlap, and deepen existing overlaps only slightly. Without the brake the overlaps of a jam would grow until
  /// strands pass through each other.
  [[nodiscard]] double unsettled_fraction(const Vec* v, double dt_s) const noexcept;

  /// As safe_fraction(), but for every pair on the list, with a lower bound of its distance: the last measured distance
  /// minus the largest possible motion since then.
  [[nodiscard]] double safe_fraction_of_pairs(const Motion& motion, const State& state, double dt_s) const noexcept;

  [[nodiscard]] const std::vector<Contact>& contacts() const noexcept { return contacts_; }

 private:
  [[nodiscard]] Contact* add(double gap_m, double reach_m, double mu, Vec& impulse, char& stuck) noexcept;
  [[nodiscard]] bool find_due(const Motion& motion, double dt_s, Work& work) noexcept;
  template <bool Smooth>
  void measure(const std::int32_t* places, const State& state) noexcept;
  void bend(const State& state) noexcept;
  void bend_row(Contact& c, int at, double s, const State& state) const noexcept;
  [[nodiscard]] bool find_near(const State& state, double dt_s, Pieces& pieces) noexcept;
  /// Bin of a material coordinate, m, in heads_.
  [[nodiscard]] std::size_t bin(double at_m) const noexcept;
  [[nodiscard]] bool has_contact_at(const Near& one, double reach_m, long& compared) const noexcept;
  [[nodiscard]] bool choose_near(Work& work, Pieces& pieces) noexcept;
  /// Makes a measured pair a contact if `measured.touches` says so. @return true if it says so (even if there was no
  /// room for the contact).
  bool take(Candidate& pair, const Measured& measured, const State& state, double mu, ContactReport& report) noexcept;
  [[nodiscard]] bool make_columns(const ContactMetric& metric, TickTime& time) noexcept;
  void make_column(Contact& c, const ContactMetric& metric, float* column) const noexcept;
  [[nodiscard]] Contact& loaded(std::size_t k) noexcept { return contacts_[loaded_[k]]; }
  /// Does one pass of the sweep solver, without Anderson mixing. @return an upper bound of the largest squared velocity
  /// change.
  template <bool Friction, bool Turns>
  double plain_pass(BandSolver& solver, Vec* v, TickTime& time) noexcept;
  template <bool Turns>
  void mix(BandSolver& solver, Vec* v) noexcept;
  template <bool Turns>
  [[nodiscard]] double merit(const Vec* v) const noexcept;
  /// Relative velocity of the two points of contact row k, m/s.
  template <bool Turns>
  [[nodiscard]] Vec velocity(int k, const Vec* v) const noexcept;
  [[nodiscard]] static Vec velocity(const Contact& c, const Vec* v) noexcept {
    Vec u = -c.surface;
    for (int j = 0; j < c.count; ++j) u += c.w[j] * v[c.node[j]];
    return u;
  }
  /// Adds A^-1 extra_ to the velocities v of the window's nodes (extra_: added impulse of each node). @return an upper
  /// bound of the largest squared velocity change.
  double push(BandSolver& solver, Vec* v) noexcept;
  void clear_extra() noexcept;
  template <bool Friction, bool Turns>
  void sweep(const Vec* v, TickTime& time) noexcept;
  /// Limits and progress of Newton's method in a substep.
  struct Search {
    const Effort& effort;
    ContactReport& report;
    long nodes;          ///< number of nodes in the window
    int look = 0;        ///< checks of all contacts so far
    bool fresh = false;  ///< the inverse matrix Z = A^-1 was computed in this substep
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
};

/// The impulse p, with its tangential part limited to mu p_n (Coulomb's cone about the normal n); zero if p_n <= 0.
[[nodiscard]] inline Vec in_cone(Vec p, Vec n, double mu) noexcept {
  const double pn = dot(p, n);
  if (pn <= 0.0) return Vec{};
  const Vec pt = p - pn * n;
  return pn * n + limited(pt, mu * pn);
}

template <bool Turns>
Vec ContactSet::velocity(int k, const Vec* v) const noexcept {
  Vec u = velocity(contacts_[k], v);
  if constexpr (Turns) u += turning_.slip(k);
  return u;
}

}  // namespace ligature::physics::rod
