#pragma once
// A throw in a thread that stands by itself: the loop between two pairs of jaws is an elastic arch, not a hanging
// bight.

#include "sim_device/operator/throw.hpp"

namespace ligature::sim {

/// Does a piece of the length that a throw is made of stand by itself? Bend length (EI / weight per length)^(1/3)
/// against the thread's length: nylon 3-0 of 0.3 m 0.27, the paper's suture 0.12.
[[nodiscard]] bool is_springy(const Workplace& place);

/// The end is raised below the corner until the thread between them gives way to one side, then led round to the front
/// so that the arch comes to stand out past the corner. It does so about the vertical in one sense only: an arch and
/// its mirror image do not turn into each other, so where the thread gave way to decides where the end goes first.
[[nodiscard]] Move open_arch(const Throw& t, const WhereAlong& corner);

/// The end, held by the right hand, goes over the standing part and through the loop, in one path without a stop: an
/// overhand that is still open. The left hand holds the corner, the standing part is level: on a slope X, where the
/// end crosses over, slides down to the corner and there is no room left to pass.
///
/// Both pairs of jaws closed on the hanging thread, so both ends of the arch point straight down for good. Such an arch
/// can turn about the vertical without bending or twisting more, and turns until it stands out on the side away from
/// the end. So: the end is led far out to the front and up, over the standing part (the arch stands out in front),
/// close behind it towards the corner (the arch turns to the anchor and the end is ahead of X), forward under the
/// standing part and on past the corner, before the arch has turned once more.
/// @param corner, turn places along the thread of the corner and of where the end goes over. All lengths of the path
/// are shares of the working part. With `t.passes` 2 it goes round the standing part once more on the way.
///
/// With `t.against` (figure-eight) it does not come forward through the arch but round below it, and goes through to the
/// back. A whole turn about the standing part, as in a rope, is dragged over the corner by the arch; round the arch's
/// lower strand it is the same knot, and that strand cannot run away.
[[nodiscard]] Move springy_throw(const Throw& t, const WhereAlong& corner, const WhereAlong& turn);

}  // namespace ligature::sim
