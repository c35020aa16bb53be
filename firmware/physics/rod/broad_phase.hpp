#pragma once
// Which pairs of segments could touch before the list is made again.

#include <cstdint>
#include <vector>

#include "firmware/physics/rod/state.hpp"

namespace ligature::physics::rod {

/// A pair that is watched, and what is known about it. Kept from substep to substep.
struct Candidate {
  std::int32_t a = 0;    ///< segment of the thread
  std::int32_t b = 0;    ///< another segment, >= a + 2
  double reach_m = 0.0;  ///< centre distance at which they touch
  double due = 0.0;      ///< gap when last measured + 2 x travel then: minus 2 x travel now, a lower bound of the gap
  double s_a = 0.0, s_b = 0.0;  ///< material coordinates of the closest points, m
  Vec impulse{};                ///< of the last substep, on b's side, N s
};

/// Pairs within reach + margin. Blocks of eight neighbouring segments first, by bounding spheres, then the segments, so
/// the cost grows like the thread's length, not its square, for all but a few hundred nanoseconds per 100 nodes.
/// Pairs nearer than 0.6 diameters along the thread are left out: they cannot pass each other without folding it;
/// pairs an arc a < pi d / 2 apart touch at d sin(a / d), as near as a bent tube of constant thickness allows.
class BroadPhase {
 public:
  void reserve(int nodes, int pairs);

  /// Rebuilds `list`; impulses of pairs that stay are kept. @return false when there was no room for all pairs.
  bool build(const State& state, double diameter_m, double margin_m, std::vector<Candidate>& list) noexcept;

 private:
  struct Ball {
    float x, y, z, r;
  };
  int capacity_ = 0;
  std::vector<float> x_, y_, z_, r_;
  std::vector<Ball> blocks_;
  std::vector<Candidate> old_;
};

}  // namespace ligature::physics::rod
