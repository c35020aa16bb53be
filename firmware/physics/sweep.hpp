#pragma once

#include <vector>

#include "firmware/physics/broad_phase.hpp"

namespace ligature::physics {

/// Sweep and prune: segments sorted by their lower end along the axis on which the thread is most spread out; only
/// those whose intervals overlap are tested. The order is kept from call to call, so that sorting is nearly free while
/// the thread moves little. Cost: n log n at worst for sorting, plus the overlapping intervals.
class Sweep {
 public:
  Sweep() = default;
  explicit Sweep(int segments);

  /// The same pairs, in the same order, as find_pairs_brute.
  void find_pairs(const SegmentSpheres& s, double reach_m, int skip, PairList& out) noexcept;

 private:
  struct Interval {
    double low_m, high_m;
    std::int32_t segment;
  };
  void sort_intervals(const SegmentSpheres& s, double reach_m) noexcept;

  std::vector<Interval> intervals_;
};

}  // namespace ligature::physics
