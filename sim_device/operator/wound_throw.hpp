#pragma once
// A throw wound as a helix around the standing part, and knots of several such throws side by side.

#include <memory>
#include <span>

#include "sim_device/operator/throw.hpp"

namespace ligature::sim {

/// Places of a throw along the thread, m, at the time when it begins.
struct Site {
  double base = 0.0;    ///< start of the standing part: the anchor, or the end of the existing knot
  double corner = 0.0;  ///< where the left hand holds the thread
};

/// One throw. The left hand holds the standing part outwards and upwards, so that the thread beyond the corner hangs in
/// a bight: a loop whose upper edge is the standing part. The right hand leads the end up beside the standing part and
/// winds it around, moving towards the corner. So the end passes through the loop once per turn: one turn makes an
/// overhand (3_1), two turns a surgeon's first throw (5_1). The standing part rises towards the corner, so that thread
/// laid over it slides away from the corner. If the standing part sloped down, that thread would slide to the corner,
/// where the end must pass, and close the loop too early. Both hands are empty before and after. `t.against` is
/// ignored.
[[nodiscard]] Moves wound_throw(const Throw& t, const std::shared_ptr<const Site>& site);

/// All throws of a knot, each beyond the previous one. After each throw the whole thread is checked. Each throw is
/// drawn small, and the corner is swung out on an arc with the thread taut. So nothing passes through an earlier throw,
/// and the knot is the sum of its throws.
[[nodiscard]] Moves throws_in_a_row(std::span<const Throw> throws);

/// Extent of the knotted part: arc length of the first and the last place where the thread touches itself, m; {length,
/// 0} if there is none. Sampled once per diameter, O((l/d)^2); neighbours within three diameters do not count.
struct Tangle {
  double first_m = 0.0, last_m = 0.0;
};
[[nodiscard]] Tangle tangle(const Look& look);

}  // namespace ligature::sim
