#pragma once
// The contact budget of a tick, in instructions. It is checked before each piece of work, so it is kept in any state of
// the thread.

#include <algorithm>

#include "firmware/physics/members.hpp"
#include "firmware/physics/time_left.hpp"

namespace ligature::physics::rod {

/// Prices of pieces of work, in instructions of the x86-64-v3 build, rounded up (docs/measurements/accuracy.md). The
/// cost of a substep without contact (forces, matrix, one solution) is proportional to the number of nodes and is not
/// charged.
namespace price {
inline constexpr long kCheck = 45;           ///< test whether a listed pair, or a group of pairs, must be measured
inline constexpr long kMeasure = 340;        ///< closest points of the chords of four pairs
inline constexpr long kSmooth = 450;         ///< added for four pairs that are near: the smooth curves
inline constexpr long kPlace = 130;          ///< is a measured pair near, and is there a contact at its place?
inline constexpr long kBeside = 12;          ///< added to kPlace for each contact with which the place is compared
inline constexpr long kTake = 210;           ///< making a contact of a measured pair
inline constexpr long kCorner = 20;          ///< corner of the smooth curve at one node
inline constexpr long kGuard = 130;          ///< guard check of a measured pair or a contact
inline constexpr long kGuardListed = 60;     ///< guard check of a pair that was not measured
inline constexpr long kWorldNode = 60;       ///< one node against the floor or one body
inline constexpr long kBody = 190;           ///< added when the node may touch the body
inline constexpr long kBall = 60;            ///< broad phase: block against a sphere of the tree
inline constexpr long kSphere = 130;         ///< broad phase: segment against a block of eight
inline constexpr long kConsider = 75;        ///< broad phase: pair whose spheres overlap
inline constexpr long kList = 140;           ///< broad phase: exact distance of such a pair, and adding it to the list
inline constexpr long kChangePerNode = 180;  ///< remeshing: one merge with one split, per node of the thread

/// Price of setting up `rows` contact rows that act on a window of `nodes` nodes, and of the two solutions in
/// ContactSet::start().
[[nodiscard]] constexpr long rows(long rows, long nodes) noexcept { return 260 * rows + 170 * nodes; }
/// Price of one row in a pass of the sweep solver, 1.3 times its instructions. Each row waits for the result of the row
/// before, so with contacts between smooth curves it takes as long as other work of so many instructions.
[[nodiscard]] constexpr long row_of_pass(long nodes) noexcept { return 150 + 2 * nodes; }
/// Price of one pass over `rows` rows, of which `loaded` carry an impulse and take part in Anderson mixing.
[[nodiscard]] constexpr long pass(long rows, long loaded, long nodes) noexcept {
  return rows * row_of_pass(nodes) + loaded * 235 + 130 * nodes;
}
/// Prices for a window of `nodes` nodes. factors(): copying the matrix factors. column(): one column of the inverse
/// matrix.
[[nodiscard]] constexpr long factors(long nodes) noexcept { return 60 * nodes; }
[[nodiscard]] constexpr long column(long nodes) noexcept { return 95 * nodes; }
/// Price of computing the relative velocities of `rows` contacts, and of checking their conditions.
[[nodiscard]] constexpr long look(long rows) noexcept { return 170 * rows; }
/// Price of the coupling matrix of contacts, for new contacts and new pairs of contacts on a window of `nodes` nodes.
/// Latency limits couple(), exchange() and dense_sweep(), so their prices follow from their time and exceed their
/// instruction counts.
[[nodiscard]] constexpr long couple(long contacts, long pairs, long nodes) noexcept {
  return contacts * (200 + 35 * nodes) + 70 * pairs;
}
/// Price of determining the kinds (open, sticking, sliding) and residuals of `loaded` contacts in Newton's system.
[[nodiscard]] constexpr long read(long loaded) noexcept { return 200 * loaded; }
/// Price of computing the velocities of `nodes` nodes for new impulses of `loaded` contacts, by one solution of the
/// full system.
[[nodiscard]] constexpr long answer(long loaded, long nodes) noexcept { return 55 * loaded + 100 * nodes; }
/// Price of a sweep over `loaded` contacts of Newton's system, and of determining their kinds after it.
[[nodiscard]] constexpr long dense_sweep(long loaded) noexcept { return loaded * (550 + 2 * loaded); }
/// Price of exchanging two contacts, `changes` times, in a coupling matrix of `slots` contacts.
[[nodiscard]] constexpr long exchange(long changes, long slots) noexcept { return 140 * changes * slots; }
/// Price of one Newton step with `loaded` contacts and `unknowns` unknowns.
[[nodiscard]] constexpr long newton(long loaded, long unknowns) noexcept {
  return unknowns * (300 + 8 * unknowns + unknowns * unknowns / 14) + 1500 + 400 * loaded;
}
/// Largest number of contact rows whose setup and one pass cost no more than `allowance`.
[[nodiscard]] constexpr long affordable_rows(long allowance, long nodes) noexcept {
  const long fixed = rows(0, nodes) + pass(0, 0, nodes);
  return std::max(0L, allowance - fixed) / (rows(1, nodes) + pass(1, 1, nodes) - fixed);
}
/// Price of inverting the sweeps' simplified matrix (contact_metric.hpp) on `window` nodes of a thread with `nodes`
/// nodes.
[[nodiscard]] constexpr long metric(long nodes, long window) noexcept { return 45 * nodes + 9 * window * window / 2; }
}  // namespace price

/// Counts the work of a tick against its budget. Callers charge their work with spend(). When the tick's time is over,
/// left() is 0 even if some budget remains. The clock is queried between pieces of work of at most kPiece instructions.
class Work {
 public:
  static constexpr long kPiece = 100'000;

  void start(long budget, const TimeLeft& left = {}, std::int64_t piece_ns = TickTime::kPiece_ns) noexcept {
    budget_ = budget, used_ = 0;
    time_.start(left, piece_ns);
  }
  void spend(long instructions) noexcept { used_ += instructions; }
  [[nodiscard]] long budget() const noexcept { return budget_; }
  [[nodiscard]] long used() const noexcept { return used_; }
  [[nodiscard]] long unspent() const noexcept { return std::max(0L, budget_ - used_); }  ///< ignores the clock
  [[nodiscard]] long left() const noexcept { return time_.is_over() ? 0 : unspent(); }
  [[nodiscard]] TickTime& time() noexcept { return time_; }
  [[nodiscard]] const TickTime& time() const noexcept { return time_; }
  /// The members that an image saves (image.hpp): all but the clock, whose measurements are valid only on this machine.
  [[nodiscard]] static auto members(Work& self) noexcept {
    auto& [budget, used, time] = self;
    return std::tie(budget, used);
  }

 private:
  long budget_ = 0, used_ = 0;
  TickTime time_;
};

/// Groups many small pieces of work, so that the clock is queried only once per Work::kPiece instructions.
class Pieces {
 public:
  explicit Pieces(TickTime& time) noexcept : time_(time) {}
  /// @return false when the time is over.
  [[nodiscard]] bool allow(long instructions) noexcept {
    since_ += instructions;
    if (since_ < Work::kPiece) return !time_.is_over();
    since_ = 0;
    return time_.allows();
  }

 private:
  TickTime& time_;
  long since_ = 0;
};

}  // namespace ligature::physics::rod
