#pragma once
// Broad phase: the list of segment pairs that could touch before the list is rebuilt.

#include <array>
#include <cstdint>
#include <vector>

#include "firmware/physics/members.hpp"
#include "firmware/physics/rod/contact/motion.hpp"
#include "firmware/physics/rod/contact/touch.hpp"
#include "firmware/physics/rod/model/state.hpp"
#include "firmware/physics/rod/work.hpp"

namespace ligature::physics::rod {

/// A pair of segments that may touch soon, and the data that is kept for it from substep to substep.
struct Candidate {
  std::int32_t a = 0;    ///< segment of the thread
  std::int32_t b = 0;    ///< another segment, >= a + 2
  double reach_m = 0.0;  ///< distance of the centrelines at which they touch
  double near_m = 0.0;   ///< gap below which they are a contact at any speed
  double due = 0.0;      ///< gap + relative motion so far (Motion::gone()), both when the pair was last measured; due
                         ///< minus the relative motion until now is a lower bound of the present gap
  Touch touch{};         ///< points at which the impulse acted in the last substep
  Touch next{};          ///< points at which it acts in this substep
  Vec impulse{};         ///< of the last substep, on segment b, N s
  char stuck = 0;        ///< 1: static friction held in the last substep
  double bulge_m = 0.0;  ///< by how much the smooth curves can be nearer than the chords; 0: contact is between chords
  LIGATURE_MEMBERS(Candidate, a, b, reach_m, near_m, due, touch, next, impulse, stuck, bulge_m)
};

/// The pairs first .. last - 1 of a list: all listed pairs between two blocks of segments (motion.hpp). One test of the
/// group can show that none of these pairs must be measured.
struct PairGroup {
  std::int32_t first = 0, last = 0;
  std::int32_t p = 0, q = 0;  ///< indices of the two blocks
  double due = kAtOnce;       ///< smallest due - near_m of the pairs, so that due - Motion::gone_of_blocks() is a lower
                              ///< bound of gap - near_m for all of them
  LIGATURE_MEMBERS(PairGroup, first, last, p, q, due)

  static constexpr double kAtOnce = -1e300;  ///< value of `due` when a pair touched: always test the pairs
};

/// The list that is built: pairs in the order of their groups.
struct PairList {
  std::vector<Candidate>& pairs;
  std::vector<PairGroup>& groups;
};

/// Margins of a list. It contains every pair whose gap is below skin_m + horizon_s x its relative speed (an upper
/// bound: Motion::rate()).
struct Outlook {
  double diameter_m = 0.0, skin_m = 0.0, near_m = 0.0, horizon_s = 0.0;
};

/// Builds the list of pairs. Tests first blocks of eight neighbouring segments in a tree of bounding spheres, then the
/// spheres of single segments, then exact distances. So the cost grows in proportion to the thread's length. The list's
/// margin depends on each pair's own relative speed, so neither one fast end nor a fast motion of the whole thread
/// makes the list long.
/// Pairs less than 0.6 diameters apart along the thread are left out: they can cross only if the thread folds. Pairs
/// that are an arc a < pi d / 2 apart along the thread touch at the distance d sin(a / d), the smallest that a bent
/// tube of constant thickness allows. On a straight thread the gap of such a pair is a - d sin(a / d). It becomes a
/// contact when its gap falls below half of that, or below near_m if near_m is smaller.
class BroadPhase {
 public:
  static constexpr double kLeastArc = 0.6;     ///< smallest distance along the thread of a listed pair, in diameters
  static constexpr double kLeastReach = 0.56;  ///< sin(kLeastArc), rounded down: smallest reach_m, in diameters

  void reserve(int nodes, int pairs);

  /// Stores the impulses of all pairs, so that build() can restore them in the new list. @pre not more pairs than
  /// reserved
  void keep_impulses(const std::vector<Candidate>& list) noexcept;

  /// Rebuilds `list`, with the gap of every pair measured and the kept impulses restored. Calls motion.restart(), so
  /// that relative motion counts from this moment.
  /// @param allowance most work that build() may use. @return false if allowance, room for pairs or the tick's time was
  /// too small; then the list is invalid.
  bool build(const State& state, Motion& motion, const Outlook& outlook, long allowance, Work& work,
             const PairList& list) noexcept;

  /// Call after a failed build(). Fills the list with only the pairs whose impulse was stored, so that the next
  /// keep_impulses() stores them again.
  void put_back(const PairList& list) const noexcept;

  /// The part of a build()'s cost, in instructions, that does not depend on how many segments are near each other.
  [[nodiscard]] static long least_cost(int nodes) noexcept;
  /// The members that an image saves (image.hpp): only the spent work, because a build() needs nothing from the build()
  /// before.
  [[nodiscard]] static auto members(BroadPhase& self) noexcept {
    auto& [capacity, spent, allowance, asked, time, x, y, z, half, bulge, blocks, tree, kept, places, close,
           close_count] = self;
    return std::tie(spent);
  }

 private:
  static constexpr std::size_t kBlock = Motion::kBlock;
  static constexpr int kLevels = 12;  ///< of the tree; the largest sphere holds 2^11 blocks, 16384 segments
  struct Ball {
    float x, y, z, r;
  };
  void place(const State& state, const Motion& motion, float horizon_s) noexcept;
  [[nodiscard]] std::size_t place_of(std::int32_t a, std::int32_t b) const noexcept;
  void grow_tree(std::size_t blocks) noexcept;
  void give_back(Candidate& pair) const noexcept;
  /// Adds segments a and b to close_ if their spheres are near enough.
  void consider(const State& state, const Motion& motion, const Outlook& outlook, std::size_t a,
                std::size_t b) noexcept;
  /// Measures the pairs in close_, four at a time, and adds those to the list that are near enough.
  /// @return false if there was no room.
  bool list_close(const State& state, std::vector<Candidate>& list) noexcept;
  /// Bit mask of the segments of block q whose spheres are within `reach` of segment a's sphere.
  [[nodiscard]] unsigned near(std::size_t a, std::size_t q, float reach) const noexcept;
  /// Lists the near pairs of a segment of block p and a segment of block q as a group. @return false if room or work is
  /// used up.
  bool blocks(const State& state, const Motion& motion, const Outlook& outlook, std::size_t p, std::size_t q,
              const PairList& list) noexcept;
  /// Calls blocks() for block p and every near block q >= p. @return false if room or work is used up.
  bool search(const State& state, const Motion& motion, const Outlook& outlook, std::size_t p,
              const PairList& list) noexcept;

  /// Is there time left? Queries the clock once per Work::kPiece instructions.
  [[nodiscard]] bool has_time() noexcept {
    if (spent_ - asked_ < Work::kPiece) return true;
    asked_ = spent_;
    return time_->allows();
  }

  static constexpr std::uint32_t kNobody = 0xFFFFFFFFU;
  struct Kept {
    std::int32_t a = 0, b = 0;
    std::uint32_t at = 0;  // index in places_
    Vec impulse{};
    Touch touch{};
    char stuck = 0;
  };
  int capacity_ = 0;
  long spent_ = 0, allowance_ = 0;  // work of this build, and its limit
  long asked_ = 0;                  // spent_ at the last clock query
  TickTime* time_ = nullptr;
  std::vector<float> x_, y_, z_;       // midpoints of segments
  std::vector<float> half_;            // half lengths of segments
  std::vector<float> bulge_;           // largest distance of the smooth curve from its chord
  std::vector<Ball> blocks_;           // bounding spheres of blocks, at the present positions
  std::vector<Ball> tree_[kLevels];    // spheres of 2^level blocks, enlarged by horizon x speed
  std::vector<Kept> kept_;             // stored impulses
  std::vector<std::uint32_t> places_;  // hash table, open addressing, size a power of two: indices into kept_
  struct Close {
    std::int32_t a = 0, b = 0;
    double reach_m = 0.0, bulge_m = 0.0, near_m = 0.0;  // as in Candidate
    double limit_m = 0.0;                               // distance of the chords below which the pair is listed
  };
  std::array<Close, kBlock * kBlock> close_;  // pairs of two blocks whose spheres are near
  std::size_t close_count_ = 0;
};

}  // namespace ligature::physics::rod
