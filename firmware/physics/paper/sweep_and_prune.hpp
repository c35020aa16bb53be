#pragma once

#include <vector>

#include "firmware/physics/members.hpp"
#include "firmware/physics/paper/broad_phase.hpp"

namespace ligature::physics {

/// Sweep and prune: segments are sorted by their lower end along the axis of the thread's largest extent; only pairs
/// with overlapping intervals are tested. The order is kept between calls, so sorting is cheap while the thread moves
/// little. Cost: sorting O(n log n) at worst, plus the number of overlapping intervals.
class Sweep {
 public:
  Sweep() = default;
  explicit Sweep(int segments);

  /// Finds the same pairs, in the same order, as find_pairs_brute().
  void find_pairs(const SegmentSpheres& s, double reach_m, int skip, PairList& out) noexcept;
  LIGATURE_MEMBERS(Sweep, intervals)

 private:
  struct Interval {
    double low_m, high_m;
    std::int32_t segment;
    LIGATURE_MEMBERS(Interval, low, high, index)
  };
  void sort_intervals(const SegmentSpheres& s, double reach_m) noexcept;

  std::vector<Interval> intervals_;
};

}  // namespace ligature::physics
