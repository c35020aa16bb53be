#pragma once
// Where along the thread a contact presses.

#include <algorithm>

namespace ligature::physics::rod {

/// The points of a pair at which its impulse acts: the nearest ones, found at the start of a substep. Where two strands
/// lie almost side by side, a hair's turn moves those far along, and the impulse there turns them back: a stiff spring
/// that answers a substep late. Left to itself it overshoots, and the points ring from substep to substep (by 1.5 % of
/// a segment, which moved a loose neighbour by 25 mm/s in the held square knot). So a point goes `share` of its way: as
/// much as would have met the answer of the last substep [Irons & Tuck 1969], and all of it where nothing answers, as
/// when strands slide.
struct Touch {
  static constexpr double kLeastShare = 0.02, kMore = 1.2;

  double a = 0.0, b = 0.0;          ///< material coordinates, m
  double way_a = 0.0, way_b = 0.0;  ///< from the last points to the nearest, in the last substep, m
  double share = 1.0;               ///< of that, what was gone

  /// There was no contact before.
  void begin(double at_a, double at_b) noexcept { *this = {at_a, at_b}; }
  void follow(double to_a, double to_b) noexcept {
    const double now_a = to_a - a, now_b = to_b - b;
    const double last2 = way_a * way_a + way_b * way_b;
    if (last2 > 0.0) {
      const double rest = (now_a * way_a + now_b * way_b) / last2;  // of the last way; overshot: below zero
      const double best = rest < 1.0 ? share / (1.0 - rest) : 1.0;
      share = std::clamp(best, kLeastShare, std::min(1.0, kMore * share));
    }
    way_a = now_a, way_b = now_b;
    a += share * now_a, b += share * now_b;
  }
};

}  // namespace ligature::physics::rod
