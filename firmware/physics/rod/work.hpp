#pragma once
// What touching may cost in a tick: priced before it is done, in instructions, so that the bound holds for any state.

#include <algorithm>

#include "firmware/physics/time_left.hpp"

namespace ligature::physics::rod {

/// Prices in instructions of the x86-64-v3 build, rounded up; docs/accuracy.md says how they were counted. What a
/// substep costs without contact (forces, matrix, one solution) is linear in the nodes and not on the meter.
namespace price {
inline constexpr long kCheck = 45;           ///< a listed pair, or a group of them, in a substep: can it meet?
inline constexpr long kMeasure = 340;        ///< four that can: their closest points
inline constexpr long kSmooth = 450;         ///< four that are near: between smooth curves instead
inline constexpr long kTake = 210;           ///< one that was measured: a row to be
inline constexpr long kCorner = 20;          ///< and each node from the first of these to the last
inline constexpr long kGuard = 130;          ///< its part in the guard
inline constexpr long kGuardListed = 60;     ///< that of a pair that was not measured
inline constexpr long kWorldNode = 60;       ///< a node against the floor or a body
inline constexpr long kBody = 190;           ///< and it may touch the body
inline constexpr long kBall = 60;            ///< broad phase: a block against a sphere of the tree
inline constexpr long kSphere = 130;         ///< broad phase: a segment against a block of eight
inline constexpr long kConsider = 75;        ///< broad phase: a pair whose spheres meet
inline constexpr long kList = 140;           ///< broad phase: such a pair listed
inline constexpr long kExact = 100;          ///< broad phase: and measured before
inline constexpr long kChangePerNode = 180;  ///< remeshing: one merge with one split

/// Making `rows` rows on a window of `nodes`, and the two solutions that start them.
[[nodiscard]] constexpr long rows(long rows, long nodes) noexcept { return 260 * rows + 170 * nodes; }
/// One pass over them, of which `loaded` carry an impulse and are mixed.
[[nodiscard]] constexpr long pass(long rows, long loaded, long nodes) noexcept {
  return rows * (115 + 3 * nodes / 2) + loaded * 180 + 130 * nodes;
}
/// Keeping the factors of a window, and a column of their inverse.
[[nodiscard]] constexpr long factors(long nodes) noexcept { return 60 * nodes; }
[[nodiscard]] constexpr long column(long nodes) noexcept { return 95 * nodes; }
/// What impulses make of `rows` contacts.
[[nodiscard]] constexpr long look(long rows) noexcept { return 170 * rows; }
/// Contacts that are to be coupled densely on a window of `nodes`, and pairs of them. This, exchanges and sweeps wait
/// for memory or for the last result: their prices are what their time would buy of the other instructions.
[[nodiscard]] constexpr long couple(long contacts, long pairs, long nodes) noexcept {
  return contacts * (200 + 35 * nodes) + 70 * pairs;
}
/// What impulses make of contacts that are coupled densely.
[[nodiscard]] constexpr long read(long loaded) noexcept { return 200 * loaded; }
/// The velocities that answer to new impulses of `loaded` contacts.
[[nodiscard]] constexpr long answer(long loaded, long nodes) noexcept { return 55 * loaded + 100 * nodes; }
/// A sweep over `loaded` contacts that are coupled densely, and what it makes of them.
[[nodiscard]] constexpr long dense_sweep(long loaded) noexcept { return loaded * (550 + 2 * loaded); }
/// Contacts that change places among `slots`, so that those which carry load come first.
[[nodiscard]] constexpr long exchange(long changes, long slots) noexcept { return 140 * changes * slots; }
/// One of Newton's steps: `loaded` contacts, `unknowns` impulses.
[[nodiscard]] constexpr long newton(long loaded, long unknowns) noexcept {
  return unknowns * (300 + 8 * unknowns + unknowns * unknowns / 14) + 1500 + 400 * loaded;
}
/// The most rows for which `passes` passes can be paid.
[[nodiscard]] constexpr long affordable_rows(long allowance, long nodes, long passes) noexcept {
  const long fixed = rows(0, nodes) + passes * pass(0, 0, nodes);
  return std::max(0L, allowance - fixed) /
         (rows(1, nodes) - rows(0, nodes) + passes * (pass(1, 1, nodes) - pass(0, 0, nodes)));
}
/// The table of C^-1.
[[nodiscard]] constexpr long metric(long nodes, long window) noexcept { return 45 * nodes + 9 * window * window / 2; }
}  // namespace price

/// The meter of a tick. Spending is the caller's promise; the meter only counts. It ends early when the tick's time is
/// over, which is asked where a piece of work begins: no more than kPiece lies between two questions.
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
  [[nodiscard]] long unspent() const noexcept { return std::max(0L, budget_ - used_); }  ///< whatever the time
  [[nodiscard]] long left() const noexcept { return time_.is_over() ? 0 : unspent(); }
  [[nodiscard]] TickTime& time() noexcept { return time_; }
  [[nodiscard]] const TickTime& time() const noexcept { return time_; }

 private:
  long budget_ = 0, used_ = 0;
  TickTime time_;
};

/// Between many small pieces: asks once in Work::kPiece.
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
