#include "firmware/physics/paper/bvh.hpp"

#include <algorithm>

namespace ligature::physics {

SphereTree::SphereTree(int segments) {
  while (leaves_ < static_cast<std::size_t>(segments)) leaves_ *= 2;
  balls_.resize(2 * leaves_);
}

void SphereTree::build(const SegmentSpheres& s) noexcept {
  for (int i = 0; i < s.count; ++i) balls_[leaves_ + static_cast<std::size_t>(i)] = {s.centre.at(i), s.half_m[i], i, i};
  for (std::size_t k = leaves_ - 1; k > 0; --k) {
    const Ball &a = balls_[2 * k], &b = balls_[2 * k + 1];
    if (b.radius_m < 0.0) {
      balls_[k] = a;
      continue;
    }
    const V3<double> centre = 0.5 * (a.centre + b.centre);
    const double radius = larger(norm(a.centre - centre) + a.radius_m, norm(b.centre - centre) + b.radius_m);
    balls_[k] = {centre, radius * (1.0 + 1e-12), a.first, b.last};
  }
}

void SphereTree::within(std::size_t k, const Search& search) const noexcept {
  if (k >= leaves_ || balls_[k].last - balls_[k].first < search.skip) return;
  within(2 * k, search);
  within(2 * k + 1, search);
  between(2 * k, 2 * k + 1, search);
}

/// Finds pairs of a segment in the subtree of tree node a and a segment in the subtree of tree node b. @pre along the
/// thread, the segments of a come before those of b
void SphereTree::between(std::size_t a, std::size_t b, const Search& search) const noexcept {
  const Ball &x = balls_[a], &y = balls_[b];
  if (x.radius_m < 0.0 || y.radius_m < 0.0 || y.last - x.first < search.skip) return;
  if (a >= leaves_ && b >= leaves_) {
    if (segments_near(search.spheres, x.first, y.first, search.reach_m)) search.out.add({x.first, y.first});
    return;
  }
  const V3<double> apart = x.centre - y.centre;
  const double limit = (x.radius_m + y.radius_m + search.reach_m) * (1.0 + 1e-9);
  if (dot(apart, apart) > limit * limit) return;
  if (b >= leaves_ || (a < leaves_ && x.radius_m >= y.radius_m)) {
    between(2 * a, b, search);
    between(2 * a + 1, b, search);
  } else {
    between(a, 2 * b, search);
    between(a, 2 * b + 1, search);
  }
}

void SphereTree::find_pairs(const SegmentSpheres& s, double reach_m, int skip, PairList& out) noexcept {
  out.pairs.clear();
  out.overflow = false;
  build(s);
  within(1, {s, reach_m, skip, out});
  std::sort(out.pairs.begin(), out.pairs.end());
}

}  // namespace ligature::physics
