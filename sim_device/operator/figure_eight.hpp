#pragma once
// A throw against the turn, a figure-eight's: the end goes once more round the standing part and comes back through the
// loop from the front. Then the drawing of a throw around a corner that is held, this one or a springy thread's.

#include <memory>

#include "sim_device/operator/loop.hpp"
#include "sim_device/operator/throw.hpp"

namespace ligature::sim {

/// The end, held by the right hand, goes around the standing part at place `s`, a whole turn: the second time nearer to
/// the anchor than X, until it is in front of the loop.
[[nodiscard]] Moves lay_turn(std::shared_ptr<Loop> loop, WhereAlong s);
/// The end goes through the loop. Looked at (over, under: is it a knot?) and done again when it missed.
[[nodiscard]] Moves pass_through(std::shared_ptr<Loop> loop, const Throw& t, WhereAlong s);
/// The right hand draws the end out along `direction`, past the corner that the left hand still holds, until the loop
/// is small or the pull is felt: so the knot forms where the corner is, and does not run off the end.
[[nodiscard]] Move draw_through(std::shared_ptr<Loop> loop, const Throw& t, Vec3 direction);

}  // namespace ligature::sim
