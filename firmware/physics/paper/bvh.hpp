#pragma once

#include <vector>

#include "firmware/physics/paper/broad_phase.hpp"

namespace ligature::physics {

/// The paper's broad phase (V.A): a tree of bounding spheres over consecutive segments. It is built bottom-up, and
/// tested against itself top-down. Segments that are near along the thread are also near in space, so only the spheres
/// change, never the tree's topology. Cost: O(n) to build; O(n log n) or more to find the pairs of a thread that
/// touches itself.
class SphereTree {
 public:
  SphereTree() = default;
  explicit SphereTree(int segments);

  /// Finds the same pairs, in the same order, as find_pairs_brute().
  void find_pairs(const SegmentSpheres& s, double reach_m, int skip, PairList& out) noexcept;

 private:
  struct Ball {
    V3<double> centre{};
    double radius_m = -1.0;  ///< negative: no segments below this node
    int first = 0, last = -1;
  };
  struct Search {
    const SegmentSpheres& spheres;
    double reach_m;
    int skip;
    PairList& out;
  };
  void build(const SegmentSpheres& s) noexcept;
  void within(std::size_t node, const Search& search) const noexcept;
  void between(std::size_t a, std::size_t b, const Search& search) const noexcept;

  std::size_t leaves_ = 1;   ///< a power of two
  std::vector<Ball> balls_;  ///< children of k are 2k and 2k + 1; leaves from leaves_ on
};

}  // namespace ligature::physics
