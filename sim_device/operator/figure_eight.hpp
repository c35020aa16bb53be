#pragma once
// The throw of a figure-eight: the end goes once round the standing part, and then through the loop from the front,
// against the direction in which it went round. Also the move draw_through(), which draws a throw tight while the
// corner is held; throws in springy threads use it, too.

#include <memory>

#include "sim_device/operator/loop.hpp"
#include "sim_device/operator/throw.hpp"

namespace ligature::sim {

/// The right hand leads the end a whole turn around the standing part at place `s`, ending in front of the loop and
/// closer to the anchor than X, the crossing of standing and working part that closes the loop.
[[nodiscard]] Moves lay_turn(const std::shared_ptr<Loop>& loop, const WhereAlong& s);
/// The end passes through the loop. Then the crossings show whether there is a knot; if not, the move repeats.
[[nodiscard]] Moves pass_through(const std::shared_ptr<Loop>& loop, const Throw& t, const WhereAlong& s);
/// The right hand pulls the end along `direction`, past the corner that the left hand still holds, until the loop is
/// small or the pull is felt. So the knot forms at the corner and does not slip off the end.
[[nodiscard]] Move draw_through(const std::shared_ptr<Loop>& loop, const Throw& t, const Vec3& direction);

}  // namespace ligature::sim
