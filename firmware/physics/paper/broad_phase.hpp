#pragma once

#include <cstdint>
#include <vector>

#include "firmware/physics/members.hpp"
#include "firmware/physics/paper/lanes.hpp"
#include "firmware/physics/paper/roomy_vector.hpp"

namespace ligature::physics {

/// Indices of two segments that may be near each other; first < second. In a list of find_near_sphere() both are the
/// same segment.
struct SegmentPair {
  std::int32_t first = 0, second = 0;
  friend auto operator<=>(const SegmentPair&, const SegmentPair&) = default;
  LIGATURE_MEMBERS(SegmentPair, a, b)
};

/// Bounding spheres of all segments. A sphere's centre is its segment's middle, its radius is half the segment's
/// length. Allocated once.
struct SegmentSpheres {
  Lane3 centre;
  Lane half_m;  ///< radii: half the length of each segment
  int count = 0;

  SegmentSpheres() = default;
  explicit SegmentSpheres(int segments) : centre(segments), half_m(segments), count(segments) {}
  LIGATURE_MEMBERS(SegmentSpheres, c, h, n)
  void update(const Lane3& p) noexcept;
};

/// A list of segment pairs with fixed capacity: when it is full, further pairs are dropped and `overflow` is set.
struct PairList {
  RoomyVector<SegmentPair> pairs;  ///< reserved once
  bool overflow = false;
  LIGATURE_MEMBERS(PairList, list, full)
  void add(SegmentPair pair) noexcept {
    if (pairs.size() < pairs.capacity())
      pairs.push_back(pair);
    else
      overflow = true;
  }
};

/// Are the spheres of segments i and j (centres c, radii h) within reach of each other, |c_i - c_j| <= h_i + h_j +
/// reach? `hi_and_reach` is h_i + reach. Several j are tested at once, from the given j on (pack.hpp). All broad phases
/// use this one expression, so their results are identical.
inline PackMask spheres_near(const V3<Pack>& ci, Pack hi_and_reach, const SegmentSpheres& s, int j) noexcept {
  const V3<Pack> apart = s.centre.pack(j) - ci;
  const Pack limit = hi_and_reach + s.half_m.pack(j);
  return dot(apart, apart) <= limit * limit;
}
inline bool segments_near(const SegmentSpheres& s, int i, int j, double reach_m) noexcept {
  const V3<Pack> c{splat(s.centre.x[i]), splat(s.centre.y[i]), splat(s.centre.z[i])};
  return spheres_near(c, splat(reach_m + s.half_m[i]), s, j)[0] != 0;
}

/// Finds all pairs of segments whose spheres are within reach_m of each other and whose indices differ by at least
/// `skip` (neighbours along the thread are always near, and cannot touch); in ascending order. Cost for n segments:
/// n^2 / 2 tests, four at a time.
void find_pairs_brute(const SegmentSpheres& s, double reach_m, int skip, PairList& out) noexcept;

/// Finds all segments whose sphere is within reach_m of the sphere of one other body, which has this centre and the
/// radius half_m. A segment with the index j is listed as the pair {j, j}, because the other body has no segment index.
void find_near_sphere(const SegmentSpheres& s, const V3<double>& centre, double half_m, double reach_m,
                      PairList& out) noexcept;

}  // namespace ligature::physics
