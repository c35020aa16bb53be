#include "firmware/physics/paper/sweep_and_prune.hpp"

#include <algorithm>

namespace ligature::physics {
namespace {

/// The coordinate (x, y or z) in which the spheres' centres vary most: the fewest intervals overlap along that axis.
const Lane& widest_axis(const SegmentSpheres& s) noexcept {
  const Lane* widest = &s.centre.x;
  double most = -1.0;
  for (const Lane* axis : {&s.centre.x, &s.centre.y, &s.centre.z}) {
    double sum1 = 0.0, sum2 = 0.0;
    for (int i = 0; i < s.count; ++i) sum1 += (*axis)[i], sum2 += (*axis)[i] * (*axis)[i];
    const double spread = sum2 - sum1 * sum1 / s.count;
    if (spread > most) most = spread, widest = axis;
  }
  return *widest;
}

}  // namespace

Sweep::Sweep(int segments) : intervals_(static_cast<std::size_t>(segments)) {
  for (int i = 0; i < segments; ++i) intervals_[static_cast<std::size_t>(i)] = {0.0, 0.0, i};
}

void Sweep::sort_intervals(const SegmentSpheres& s, double reach_m) noexcept {
  const Lane& axis = widest_axis(s);
  const double slack = 1e-9 * reach_m;  // margin for rounding; segments_near() decides exactly
  for (Interval& i : intervals_) {
    const double half = s.half_m[i.segment] + 0.5 * reach_m + slack;
    i.low_m = axis[i.segment] - half, i.high_m = axis[i.segment] + half;
  }
  const auto lower = [](const Interval& a, const Interval& b) { return a.low_m < b.low_m; };
  std::size_t moves = 0;  // insertion sort is fast if the old order is nearly right; otherwise std::sort below
  for (std::size_t i = 1; i < intervals_.size() && moves < 4 * intervals_.size(); ++i) {
    const Interval here = intervals_[i];
    std::size_t j = i;
    for (; j > 0 && lower(here, intervals_[j - 1]); --j, ++moves) intervals_[j] = intervals_[j - 1];
    intervals_[j] = here;
  }
  if (moves >= 4 * intervals_.size()) std::sort(intervals_.begin(), intervals_.end(), lower);
}

void Sweep::find_pairs(const SegmentSpheres& s, double reach_m, int skip, PairList& out) noexcept {
  out.pairs.clear();
  out.overflow = false;
  sort_intervals(s, reach_m);
  for (std::size_t i = 0; i < intervals_.size(); ++i)
    for (std::size_t j = i + 1; j < intervals_.size() && intervals_[j].low_m <= intervals_[i].high_m; ++j) {
      const auto [first, second] = std::minmax(intervals_[i].segment, intervals_[j].segment);
      if (second - first >= skip && segments_near(s, first, second, reach_m)) out.add({first, second});
    }
  std::sort(out.pairs.begin(), out.pairs.end());
}

}  // namespace ligature::physics
