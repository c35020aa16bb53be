#pragma once
// A throw laid as a screw around the standing part, and knots of several such throws, one beside the other.

#include <memory>
#include <span>

#include "sim_device/operator/throw.hpp"

namespace ligature::sim {

/// Where a throw goes along the thread, m, as the thread is when the throw begins.
struct Site {
  double base = 0.0;    ///< here the standing part begins: the anchor, or the end of what is knotted already
  double corner = 0.0;  ///< here the left hand holds it
};

/// One throw. The left hand holds the standing part out and up, so the thread behind the corner hangs in a bight: a
/// loop whose upper edge is the standing part. The end is led up beside it and wound round it, on towards the corner
/// all the time, so that it passes the loop once a turn: one turn makes an overhand (3_1), two a surgeon's first throw
/// (5_1). Upwards, because a thread that hangs over the standing part slides down it, away from the place where the end
/// passes; downwards it slides to the corner and closes the loop before the end is there. Both hands are empty before
/// and after. `t.against` means nothing here.
[[nodiscard]] Moves wound_throw(const Throw& t, const std::shared_ptr<const Site>& site);

/// All throws, the next beyond the last, and a look at the whole. Each is drawn small, so that the knot is the sum of
/// them: nothing passes through an earlier throw, because the corner is swung out on an arc with the thread taut.
[[nodiscard]] Moves throws_in_a_row(std::span<const Throw> throws);

/// Where the thread touches itself: arc length of the first and of the last such place, m; {length, 0} if nowhere.
/// Sampled once a diameter, O((l/d)^2); neighbours within three diameters do not count.
struct Tangle {
  double first_m = 0.0, last_m = 0.0;
};
[[nodiscard]] Tangle tangle(const Look& look);

}  // namespace ligature::sim
