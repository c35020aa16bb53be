#include "firmware/physics/paper/broad_phase.hpp"

namespace ligature::physics {

void SegmentSpheres::update(const Lane3& p) noexcept {
  for (int i = 0; i < count; i += kLanes) {
    const V3<Pack> a = p.pack(i), b = p.pack(i + 1);
    centre.set(i, splat(0.5) * (a + b));
    half_m.set(i, 0.5 * norm(b - a));
  }
}

void find_pairs_brute(const SegmentSpheres& s, double reach_m, int skip, PairList& out) noexcept {
  out.pairs.clear();
  out.overflow = false;
  for (int i = 0; i + skip < s.count; ++i) {
    const V3<Pack> c{splat(s.centre.x[i]), splat(s.centre.y[i]), splat(s.centre.z[i])};
    const Pack reach = splat(reach_m + s.half_m[i]);
    for (int j = i + skip; j < s.count; j += kLanes) {
      const PackMask near = spheres_near(c, reach, s, j);
      if (!any(near)) [[likely]]
        continue;
      for (int k = 0; k < kLanes && j + k < s.count; ++k)
        if (near[k]) out.add({i, j + k});
    }
  }
}

void find_near_sphere(const SegmentSpheres& s, const V3<double>& centre, double half_m, double reach_m,
                      PairList& out) noexcept {
  out.pairs.clear();
  out.overflow = false;
  const V3<Pack> c{splat(centre.x), splat(centre.y), splat(centre.z)};
  for (int j = 0; j < s.count; j += kLanes) {
    const PackMask near = spheres_near(c, splat(reach_m + half_m), s, j);
    if (!any(near)) continue;
    for (int k = 0; k < kLanes && j + k < s.count; ++k)
      if (near[k]) out.add({j + k, j + k});
  }
}

}  // namespace ligature::physics
