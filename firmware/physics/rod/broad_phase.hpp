#pragma once
// Which pairs of segments could touch before the list is made again.

#include <cstdint>
#include <vector>

#include "firmware/physics/rod/motion.hpp"
#include "firmware/physics/rod/state.hpp"
#include "firmware/physics/rod/touch.hpp"
#include "firmware/physics/rod/work.hpp"

namespace ligature::physics::rod {

/// A pair that is watched, and what is known about it. Kept from substep to substep.
struct Candidate {
  std::int32_t a = 0;    ///< segment of the thread
  std::int32_t b = 0;    ///< another segment, >= a + 2
  double reach_m = 0.0;  ///< centre distance at which they touch
  double near_m = 0.0;   ///< gap within which they are a contact at any speed
  double due = 0.0;      ///< gap when last measured + Motion::gone then: minus gone now, a lower bound of the gap
  Touch touch{};         ///< where the impulse acted in the last substep
  Touch next{};          ///< and does in this one
  Vec impulse{};         ///< of the last substep, on b's side, N s
  char stuck = 0;        ///< 1: inside the friction cone then
  double bulge_m = 0.0;  ///< that the smooth curves (smooth.hpp) may be nearer than their chords; 0: chords touch
};

/// The pairs first .. last - 1 of a list: those between two blocks of segments (motion.hpp). What is due for none of
/// them is looked at once, not pair by pair.
struct PairGroup {
  std::int32_t first = 0, last = 0;
  std::int32_t p = 0, q = 0;  ///< the blocks
  double due = kAtOnce;       ///< least of their dues minus near_m: minus Motion::gone_of_blocks, a lower bound

  static constexpr double kAtOnce = -1e300;  ///< when one of them touched
};

/// Where a list is made: pairs in the order of their groups.
struct PairList {
  std::vector<Candidate>& pairs;
  std::vector<PairGroup>& groups;
};

/// How far ahead a list looks: pairs within reach + skin + horizon x their rate of approach (motion.hpp) are on it.
struct Outlook {
  double diameter_m = 0.0, skin_m = 0.0, near_m = 0.0, horizon_s = 0.0;
};

/// Blocks of eight neighbouring segments first, in a tree of bounding spheres, then the segments' spheres, then the
/// exact distance of what is left, so the cost grows like the thread's length. Each pair is allowed its own motion: one
/// fast end does not fill the list, nor does a thread that is fast as a whole.
/// Pairs nearer than 0.6 diameters along the thread are left out: they cannot pass each other without folding it;
/// pairs an arc a < pi d / 2 apart touch at d sin(a / d), as near as a bent tube of constant thickness allows, and are
/// contacts when they have come nearer than in a straight thread: within 2/3 of what that leaves, if that is less than
/// near_m.
class BroadPhase {
 public:
  static constexpr double kLeastArc = 0.6;     ///< of a diameter, along the thread
  static constexpr double kLeastReach = 0.56;  ///< sin(kLeastArc), rounded down: no pair on a list touches nearer

  void reserve(int nodes, int pairs);

  /// Impulses of the list, for the lists to come; all of them. @pre no more pairs than there is room for
  void keep_impulses(const std::vector<Candidate>& list) noexcept;

  /// Rebuilds `list`, every pair measured and counted from motion.restart() on; kept impulses are given to their pairs.
  /// @param allowance  what it may spend. @return false, and the list is of no use, when that, the room for pairs or
  /// the tick's time did not do.
  bool build(const State& state, Motion& motion, const Outlook& outlook, long allowance, Work& work,
             const PairList& list) noexcept;

  /// After a build that failed: the kept impulses' pairs and nothing else, so that keep_impulses() finds them again.
  void put_back(const PairList& list) const noexcept;

  /// What a build costs before it has found anything.
  [[nodiscard]] static long least_cost(int nodes) noexcept;

 private:
  static constexpr std::size_t kBlock = Motion::kBlock;
  static constexpr int kLevels = 12;  ///< of the tree: 2^11 blocks in its largest sphere, 16384 segments
  struct Ball {
    float x, y, z, r;
  };
  void place(const State& state, const Motion& motion, float horizon_s) noexcept;
  [[nodiscard]] std::size_t place_of(std::int32_t a, std::int32_t b) const noexcept;
  void grow_tree(std::size_t blocks) noexcept;
  void give_back(Candidate& pair) const noexcept;
  /// Adds the pair if it is near enough. @return false when there was no room.
  bool consider(const State& state, const Motion& motion, const Outlook& outlook, std::size_t a, std::size_t b,
                std::vector<Candidate>& list) noexcept;
  /// Bits of those segments of block q whose spheres come within `reach` of segment a's.
  [[nodiscard]] unsigned near(std::size_t a, std::size_t q, float reach) const noexcept;
  /// All pairs of a segment of block p and one of block q. @return false when out of room or work.
  bool blocks(const State& state, const Motion& motion, const Outlook& outlook, std::size_t p, std::size_t q,
              const PairList& list) noexcept;
  /// The same for block p and all from itself on.
  bool search(const State& state, const Motion& motion, const Outlook& outlook, std::size_t p,
              const PairList& list) noexcept;

  /// Does the tick's time do for more? Asked once in Work::kPiece.
  [[nodiscard]] bool has_time() noexcept {
    if (spent_ - asked_ < Work::kPiece) return true;
    asked_ = spent_;
    return time_->allows();
  }

  static constexpr std::uint32_t kNobody = 0xFFFFFFFFU;
  struct Kept {
    std::int32_t a = 0, b = 0;
    std::uint32_t at = 0;  // its place
    Vec impulse{};
    Touch touch{};
    char stuck = 0;
  };
  int capacity_ = 0;
  long spent_ = 0, allowance_ = 0;  // of this build
  long asked_ = 0;                  // what was spent when the time was last asked for
  TickTime* time_ = nullptr;
  std::vector<float> x_, y_, z_;       // middles of segments
  std::vector<float> half_;            // half their lengths
  std::vector<float> bulge_;           // of their smooth curves
  std::vector<Ball> blocks_;           // around the segments of a block, as they are
  std::vector<Ball> tree_[kLevels];    // around 2^level blocks, swollen by what each may move
  std::vector<Kept> kept_;             // impulses
  std::vector<std::uint32_t> places_;  // open addressing, a power of two: which of kept_
};

}  // namespace ligature::physics::rod
