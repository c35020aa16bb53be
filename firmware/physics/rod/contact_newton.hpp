#pragma once
// Contacts solved by Newton's method: few of them carry load, so what couples those is a small dense system.

#include <array>
#include <cstdint>
#include <vector>

#include "firmware/physics/rod/band_columns.hpp"
#include "firmware/physics/rod/band_solver.hpp"
#include "firmware/physics/rod/contact_couplings.hpp"
#include "firmware/physics/rod/dense.hpp"
#include "firmware/physics/rod/floats.hpp"
#include "firmware/physics/rod/swept.hpp"
#include "firmware/physics/rod/work.hpp"

namespace ligature::physics::rod {

struct Contact;

/// A contact is solved when its impulse p is a fixed point of its natural map: with u its relative velocity,
///   p_n = max(0, p_n - r_n (u_n + soft p_n - target)),   p_t = disc(mu p_n, p_t - r_t u_t),
/// disc(s, q) the point of the disc of radius s nearest to q [Alart & Curnier 1991]. u = u_free + W p, and W = J Z J^T
/// with Z = A^-1, so stretch is in it. The map is linear where nothing changes its kind, so each step solves for
/// impulses of today's kinds: an open contact has none; one that sticks three; one that slides p_n (n + mu d) and,
/// across its direction d, what turning d costs. The kinds are then read anew (a primal-dual active set [Hintermueller
/// 2003]); impulses may leave their cones on the way.
///
/// Left to itself it circles: a few kinds misread, and impulses that hardly move anything (cond W is 1e5) become a
/// thousand times too large, which misreads all others. So the first step takes a change of an impulse to cost some of
/// what it does to its own contact (a proximal point [Rockafellar 1976]): weak directions wait. The cost fades from
/// step to step, at once where no kind changes, grows when a step has made the error larger, and is whole again when
/// contacts come in that no step has seen.
/// Z may be some substeps old: the caller answers each step with the true A.
class ContactNewton {
 public:
  static constexpr int kMostRows = 96;       ///< that carry load, or would
  static constexpr int kMostUnknowns = 192;  ///< impulses in them
  static constexpr int kWidest = BandColumns::kWidest;
  static constexpr int kMostNodes = 8;  ///< of a contact

  void reserve();

  /// Z is that of another mesh, or time step.
  void forget() noexcept { z_.forget(); }
  [[nodiscard]] bool covers(int first, int last) const noexcept { return z_.covers(first, last); }
  /// Z of today. @pre last - first < kWidest; solver factorised.
  void measure(const BandSolver& solver, int first, int last) noexcept;

  /// The contacts of a substep, `count` of them. What is known of those that were here before is kept, until measure().
  void start(const Contact* rows, int count) noexcept;

  /// Velocities u of all contacts: those that approach too fast are taken in. @return false when there is no room.
  [[nodiscard]] bool look(const Contact* rows, int count, const Vec* p, const Vec* u) noexcept;

  /// What those new ones do to the others, and they to them. After look(), before read(). @return false when the time
  /// was over first: what was made is kept.
  bool couple(TickTime& time = TickTime::endless()) noexcept;
  /// What couple() has yet to see: columns of Z; contacts; pairs of contacts.
  struct Uncoupled {
    long columns, contacts, pairs;
  };
  [[nodiscard]] Uncoupled uncoupled() const noexcept {
    const auto all = static_cast<long>(slots_.size()), seen = static_cast<long>(coupled_);
    return {z_.missing(), all - seen, (all * (all + 1) - seen * (seen + 1)) / 2};
  }
  [[nodiscard]] int nodes() const noexcept { return z_.width(); }  ///< of Z

  /// What impulses p and velocities u make of each contact taken in: its kind. @return the square of the largest error,
  /// m/s: how far an impulse is from its map times what it moves its contact by.
  template <bool Friction>
  [[nodiscard]] double read(const Contact* rows, const Vec* p, const Vec* u) noexcept;

  /// One sweep over the contacts taken in: settles what is easy. p and u follow.
  template <bool Friction>
  void sweep(const Contact* rows, Vec* p, Vec* u) noexcept;

  /// There was no work for more steps: in the next substep they go on from these impulses.
  void put_off(const Vec* p) noexcept;
  /// They do not: the substep was done without.
  void give_up() noexcept { put_off_ = false; }
  /// Where put_off() was, into p. @return false when it was not.
  [[nodiscard]] bool resume(Vec* p) noexcept;

  [[nodiscard]] int unknowns() const noexcept { return count_; }                          ///< impulses to solve for
  [[nodiscard]] const std::vector<std::int32_t>& rows() const noexcept { return rows_; }  ///< that carry load, or did
  [[nodiscard]] int slots() const noexcept { return static_cast<int>(slots_.size()); }
  [[nodiscard]] int exchanges() const noexcept;  ///< that the next step makes
  [[nodiscard]] int loaded() const noexcept { return static_cast<int>(rows_.size()); }

  /// Impulses that solve the kinds last read, into p; u follows. @return false when they cannot be had, or the time was
  /// over first: p and u are what they were.
  template <bool Friction>
  bool solve(const Contact* rows, Vec* p, Vec* u, TickTime& time = TickTime::endless()) noexcept;

 private:
  enum class Kind : std::uint8_t { kNew, kOpen, kSticks, kSlides };
  /// A contact that carries load, or did since measure(): who it is, how far its map steps, and what it reads there.
  struct Slot {
    std::int32_t count = 0;
    std::int32_t node[kMostNodes] = {};  ///< counted from the first of Z
    std::int32_t row = -1;               ///< or none
    std::int32_t next = -1;              ///< slot with the same first node
    double w[kMostNodes] = {};
    Vec n{};
    double soft = 0.0, r_n = 0.0, r_t = 0.0, per_r_n = 0.0, per_r_t = 0.0;
    bool dead = false;  ///< its contact has moved on, or carries nothing any more
    int idle = 0;       ///< substeps since it carried load
    Kind kind = Kind::kNew;
    Vec guess{};        ///< impulse when the work ran out
    Vec q{};            ///< p_t - r_t u_t
    Vec along{};        ///< its direction
    double most = 0.0;  ///< radius of its disc
    [[nodiscard]] bool carries() const noexcept { return row >= 0 && kind >= Kind::kSticks; }
  };
  /// One impulse x `with`, so large that along . u + give x = wanted. Solved for is what it is more than `now`, so that
  /// single precision does not limit the answer.
  struct Unknown {
    std::size_t slot;
    Vec along, with;
    double give, wanted, now;
  };
  /// Direction in which one that sticks would slide.
  struct Stuck {
    std::size_t slot;
    float x, y, z;
  };
  bool take(const Contact* rows, int k) noexcept;
  [[nodiscard]] std::size_t slot_of(std::int32_t row) const noexcept {
    return static_cast<std::size_t>(slot_[static_cast<std::size_t>(row)]);
  }
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
  void set_cost() noexcept;
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
  Floats spread_;                   // Z J^T of the slot that is being coupled, as a column of Z
  std::vector<std::int32_t> slot_;  // of each row, or -1
  std::vector<std::int32_t> at_;    // first slot of each first node, or -1
  std::vector<std::int32_t> rows_;
  std::vector<Slot> slots_;
  std::size_t coupled_ = 0;  // slots that W is known of
  bool put_off_ = false;
  bool begins_ = true;                       // there are contacts that no step has seen
  int changed_ = 0;                          // kinds that the last read() changed
  double error2_ = 0.0, last_error2_ = 0.0;  // that it saw, and the one that the last step began with
  double cost_ = 1.0;                        // of a change, 1 at first
  Couplings w_;                              // of all slots
  std::vector<Unknown>
      unknowns_;  // along n of the first carrying_ slots; across their sliding; along it, if they stick
  int count_ = 0;
  std::size_t carrying_ = 0;
  Dense dense_;
  // Scratch of assemble().
  Floats on_;  // velocities of slots: eight x, eight y, eight z
  std::vector<Stuck> stuck_;
  Floats with_;  // planes x, y, z along n, then across
  std::vector<Vec> rest_;
};

}  // namespace ligature::physics::rod
