#pragma once
// Newton's method for contacts. Only few contacts carry load, so their equations form a small dense system.

#include <array>
#include <cstdint>
#include <vector>

#include "firmware/physics/members.hpp"
#include "firmware/physics/rod/solve/band_columns.hpp"
#include "firmware/physics/rod/solve/band_solver.hpp"
#include "firmware/physics/rod/solve/contact_couplings.hpp"
#include "firmware/physics/rod/solve/dense.hpp"
#include "firmware/physics/rod/solve/floats.hpp"
#include "firmware/physics/rod/solve/node_velocities.hpp"
#include "firmware/physics/rod/work.hpp"

namespace ligature::physics::rod {

struct Contact;

/// Newton's method for all contacts of a substep. A contact is solved when its impulse p is a fixed point of its
/// natural map [Alart & Curnier 1991]
///   p_n = max(0, p_n - r_n (u_n + soft p_n - target)),   p_t = disc(mu p_n, p_t - r_t u_t)
/// u: relative velocity, target: wanted normal velocity, soft: compliance, mu: friction coefficient, r_n, r_t: step
/// lengths; _n, _t: normal and tangential parts. disc(s, q) is the point nearest to q in the disc of radius s. u =
/// u_free + W p, with W = J Z J^T (J: rows of all contacts) and Z = A^-1, stretch included.
///
/// The map is linear as long as no contact changes its kind (open, sticking, sliding). So each step fixes the kinds and
/// solves a linear system. An open contact has no unknown, a sticking one has three. A sliding one, with sliding
/// direction d, has two: one along n + mu d, and one across d with a compliance that accounts for the rotation of d.
/// Then the kinds are determined again (a primal-dual active set method [Hintermueller 2003]). Impulses may leave their
/// friction cones on the way.
///
/// Without damping this cycles: a few kinds are wrong, and impulses to which velocities hardly respond (cond W is 1e5)
/// become a thousand times too large, which makes all other kinds wrong. So a term proportional to the change of each
/// impulse is added to its equation (a proximal point method [Rockafellar 1976]), which mostly damps such weak
/// directions. This term vanishes in the solution, where impulses no longer change. With a constant factor some cycles
/// remain. So the factor is multiplied by the number of times (at least 1) that a step, or the sweep before the first
/// step, has increased the residual since the last look().
///
/// Z may be some substeps old: after each step the caller computes the velocities with the present A.
class ContactNewton {
 public:
  static constexpr int kMostRows = 96;       ///< contacts that carry load, or approach too fast without it
  static constexpr int kMostUnknowns = 192;  ///< unknown impulse components of all contacts together
  static constexpr int kWidest = BandColumns::kWidest;
  static constexpr int kMostNodes = 8;  ///< nodes on which one contact can act

  void reserve();

  /// Call when mesh or time step have changed, because Z is then no longer valid.
  void forget() noexcept { z_.forget(); }
  [[nodiscard]] bool covers(int first, int last) const noexcept { return z_.covers(first, last); }
  /// Takes Z = A^-1 from the solver's present factorisation. @pre last - first < kWidest; the solver has factorised A.
  void measure(const BandSolver& solver, int first, int last) noexcept;

  /// Begins a substep with `count` contacts. Entries of W that are known from earlier substeps are kept until the next
  /// measure().
  void start(const Contact* rows, int count) noexcept;

  /// Adds to the system all contacts that have an impulse or violate u_n >= target. @return false if there is no room.
  [[nodiscard]] bool look(const Contact* rows, int count, const Vec* p, const Vec* u) noexcept;

  /// Computes the blocks of the coupling matrix W for the added contacts. Call after look() and before read(). @return
  /// false if the time was over first; the blocks computed so far are kept.
  bool couple(TickTime& time = TickTime::endless()) noexcept;
  /// What couple() still has to compute: numbers of columns of Z, of contacts, and of pairs of contacts.
  struct Uncoupled {
    long columns, contacts, pairs;
  };
  [[nodiscard]] Uncoupled uncoupled() const noexcept {
    const auto all = static_cast<long>(slots_.size()), seen = static_cast<long>(coupled_);
    return {z_.missing(), all - seen, (all * (all + 1) - seen * (seen + 1)) / 2};
  }
  [[nodiscard]] int nodes() const noexcept { return z_.width(); }  ///< number of nodes that Z covers

  /// Determines the kind (open, sticking, sliding) of each contact in the system from impulses p and velocities u. A
  /// contact's residual is the distance of its impulse from the value of its natural map (class comment), times the
  /// contact's own velocity per unit impulse.
  /// @return the square of the largest residual, (m/s)^2.
  template <bool Friction>
  [[nodiscard]] double read(const Contact* rows, const Vec* p, const Vec* u) noexcept;

  /// One Gauss-Seidel sweep over the contacts in the system, as a cheap first improvement. Updates p and u.
  template <bool Friction>
  void sweep(const Contact* rows, Vec* p, Vec* u) noexcept;

  /// Call when work or time is used up: stores the impulses, so that the repeated substep can resume() with them.
  void put_off(const Vec* p) noexcept;
  /// Forgets the impulses of put_off(), as the substep was solved another way.
  void give_up() noexcept { put_off_ = false; }
  /// Writes the impulses stored by put_off() into p. @return false if there are none.
  [[nodiscard]] bool resume(Vec* p) noexcept;

  [[nodiscard]] int unknowns() const noexcept { return count_; }  ///< size of the next step's linear system
  [[nodiscard]] const std::vector<std::int32_t>& rows() const noexcept { return rows_; }  ///< contacts in the system
  [[nodiscard]] int slots() const noexcept { return static_cast<int>(slots_.size()); }
  [[nodiscard]] int exchanges() const noexcept;  ///< slots that the next step must reorder
  [[nodiscard]] int loaded() const noexcept { return static_cast<int>(rows_.size()); }

  /// One Newton step: solves for the impulses p with the kinds of the last read(), and updates u. @return false if the
  /// system is singular or the time was over first (then p and u are unchanged), or if the solution is not finite.
  template <bool Friction>
  bool solve(const Contact* rows, Vec* p, Vec* u, TickTime& time = TickTime::endless()) noexcept;
  /// The members that an image saves (image.hpp): all but those that every substep sets again.
  [[nodiscard]] static auto members(ContactNewton& self) noexcept {
    auto& [z, spread, slot, at, rows, slots, coupled, put_off, w, unknowns, count, last2, rises, carrying, dense, on,
           stuck, with, rest] = self;
    return std::tie(z, slot, at, rows, slots, coupled, put_off, w);
  }

 private:
  enum class Kind : std::uint8_t { kNew, kOpen, kSticks, kSlides };
  /// A contact that carries load, or has carried load since measure(): its geometry, the step lengths r_n and r_t of
  /// its natural map (class comment), and the value of that map.
  struct Slot {
    std::int32_t count = 0;
    std::int32_t node[kMostNodes] = {};  ///< counted from the first node of Z
    std::int32_t row = -1;               ///< index of its contact in this substep; -1: none
    std::int32_t next = -1;              ///< next slot with the same first node; -1: none
    double w[kMostNodes] = {};
    Vec n{};
    double soft = 0.0, r_n = 0.0, r_t = 0.0, per_r_n = 0.0, per_r_t = 0.0;
    bool dead = false;  ///< to be removed: its contact has moved too far
    Kind kind = Kind::kNew;
    Vec guess{};        ///< impulse at put_off()
    Vec q{};            ///< p_t - r_t u_t
    Vec along{};        ///< direction of q
    double most = 0.0;  ///< radius of the friction disc, mu p_n
    LIGATURE_MEMBERS(Slot, count, node, row, next, w, n, soft, r_n, r_t, per_r_n, per_r_t, dead, kind, guess, q, along,
                     most)
    [[nodiscard]] bool carries() const noexcept { return row >= 0 && kind >= Kind::kSticks; }
  };
  /// One unknown x of the linear system: the contact gets x times the impulse vector `with`, such that along . u + give
  /// x = wanted (u: relative velocity). The system is solved for x - now, so that single precision limits only the
  /// accuracy of the change.
  struct Unknown {
    std::size_t slot;
    Vec along, with;
    double give, wanted, now;
  };
  /// Direction in which a sticking contact would slide.
  struct Stuck {
    std::size_t slot;
    float x, y, z;
  };
  bool take(const Contact* rows, int k) noexcept;
  [[nodiscard]] std::size_t slot_of(std::int32_t row) const noexcept { return static_cast<std::size_t>(slot_[row]); }
  [[nodiscard]] Vec moved(std::size_t slot) const noexcept {
    const float* const u = on_.data() + on_at(slot);
    return make(u[0], u[kLanes], u[2 * kLanes]);
  }
  void spread(const Slot& slot, std::int32_t first, std::int32_t last) noexcept;
  [[nodiscard]] std::array<Four, 3> answer_at(const Slot& slot) const noexcept;
  static void set_steps(Slot& slot, const std::array<Four, 3>& own) noexcept;
  void index_slots() noexcept;
  [[nodiscard]] static bool has_moved(const Slot& slot, const Contact& c, std::int32_t first) noexcept;
  [[nodiscard]] std::int32_t find(std::int32_t a, std::int32_t b) const noexcept;
  void exchange(std::size_t a, std::size_t b) noexcept;
  [[nodiscard]] std::size_t carrying() const noexcept;
  void bring_forward() noexcept;
  template <bool Friction>
  void list_unknowns(const Contact* rows, const Vec* p, const Vec* u) noexcept;
  template <bool Two>
  void answer(std::size_t slot, Vec x, std::size_t other, Vec y) noexcept;
  void answer_all(const Vec* change) noexcept;
  template <bool Friction>
  void make_row(std::size_t i) noexcept;
  template <bool Friction>
  bool assemble(const Vec* p, TickTime& time) noexcept;

  static constexpr std::size_t kPlane = static_cast<std::size_t>(kMostRows), kLanes = Couplings::kLanes;
  [[nodiscard]] static std::size_t on_at(std::size_t slot) noexcept {
    return slot / kLanes * 3 * kLanes + slot % kLanes;
  }
  BandColumns z_;
  Floats spread_;                   // Z J^T of the slot that is being coupled, stored like a column of Z
  std::vector<std::int32_t> slot_;  // per row: index of its slot, or -1
  std::vector<std::int32_t> at_;    // per node: first slot in the list of slots that begin with this node, or -1
  std::vector<std::int32_t> rows_;
  std::vector<Slot> slots_;
  std::size_t coupled_ = 0;  // number of slots whose blocks of W are computed
  bool put_off_ = false;
  Couplings w_;  // W of all slots
  // Unknowns of the first carrying_ slots: first those along the normals, then those across the sliding directions,
  // then (for sticking contacts only) those along the sliding directions
  std::vector<Unknown> unknowns_;
  int count_ = 0;
  double last2_ = 0.0;  // squared residual at the last read()
  int rises_ = 0;       // steps since look() that have increased the residual
  std::size_t carrying_ = 0;
  Dense dense_;
  // Scratch of assemble().
  Floats on_;  // velocity changes of slots in blocks: eight x, eight y, eight z
  std::vector<Stuck> stuck_;
  Floats with_;  // Unknown::with by components: x, y, z of the normal unknowns, then of those across
  std::vector<Vec> rest_;
};

}  // namespace ligature::physics::rod
