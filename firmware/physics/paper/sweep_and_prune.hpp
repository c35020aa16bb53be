#pragma once

#include <vector>

#include "firmware/physics/members.hpp"
#include "firmware/physics/paper/broad_phase.hpp"

namespace ligature::physics {

/// Sweep and prune: sorts the segments by their lower ends along the axis of the thread's largest extent, and tests
/// only pairs whose intervals on that axis overlap. The order is kept for the next call, so sorting is cheap while the
/// thread moves little. Cost: at worst O(n log n) for sorting, plus the number of overlapping intervals.
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
