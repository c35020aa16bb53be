#pragma once
// Throws in a springy thread: between the two hands the thread stands as an elastic arch instead of hanging in a bight.

#include "sim_device/operator/throw.hpp"

namespace ligature::sim {

/// Whether a piece as long as a throw's loop stands by its own stiffness. Decided by the ratio of the bend length (EI /
/// weight per length)^(1/3) to the thread's length: 0.27 for 0.3 m of nylon 3-0, 0.12 for the paper's suture.
[[nodiscard]] bool is_springy(const Workplace& place);

/// The right hand raises the end to below the corner until the thread between the hands buckles to one side, then leads
/// the end round to the front, so that the arch stands outwards past the corner. An arch and its mirror image cannot
/// turn into each other, so the side of buckling decides in which direction the end must go first.
[[nodiscard]] Move open_arch(const Throw& t, const WhereAlong& corner);

/// The right hand leads the end over the standing part and through the loop, in one path without a stop. The result is
/// a loose overhand knot. The left hand keeps the standing part horizontal: if it sloped, the place X where the end
/// crosses it would slide to the corner and leave no room for the end.
///
/// Both jaws closed on the hanging thread, so both ends of the arch stay directed downwards. Such an arch turns freely
/// about the vertical, until it stands on the side away from the end. So the path is: far to the front and up; over the
/// standing part (the arch now stands in front); close behind it towards the corner (the arch turns to the anchor, and
/// the end is past X); forward under the standing part and on past the corner, before the arch has turned again.
/// @param corner, turn positions along the thread: of the corner, and of X. All path lengths are fractions of the
/// working part's length. With `t.passes` = 2 the end goes this way twice, first nearer to the anchor.
///
/// With `t.against` (figure-eight) the end passes below the arch and then goes through it to the back. In a limp thread
/// the end goes once round the standing part instead; in a springy one the arch would drag that turn over the corner
/// and undo it. The path below the arch makes the turn around the arch's lower strand, which stays in place; the knot
/// is the same.
[[nodiscard]] Move springy_throw(const Throw& t, const WhereAlong& corner, const WhereAlong& turn);

}  // namespace ligature::sim
