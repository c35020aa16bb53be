#pragma once
// What hands do with a thread, whatever the knot: take, carry, let go, pull tight, swing, ease. Each
// looks at the thread as it is now; none knows a node number.

#include "sim_device/operator/move.hpp"

namespace ligature::sim {

/// The tip goes to the place `s` of the thread, from the front (-y), follows it until it is between the jaws, closes
/// them and looks: where they hold nothing they open, and it comes again. A place that cannot be come at for seconds
/// (the end hangs below what the arm reaches) is given up for one a little nearer to the anchor.
[[nodiscard]] Move take(std::size_t hand, const WhereAlong& s);
/// The jaws open, and get a moment to do so.
[[nodiscard]] Move let_go(std::size_t hand);
/// To a place that may move; done within `near` clearances of it. @param pace share of full speed
[[nodiscard]] Move carry(std::size_t hand, std::string name, const Where& where, double near = 0.5, double pace = 1.0);
/// Stay for a while.
[[nodiscard]] Move wait(double seconds);
/// Until the end of the hanging thread no longer swings.
[[nodiscard]] Move hang_out();
/// The right hand draws away from the anchor along `direction` until the pull is `share` of a tight knot's.
[[nodiscard]] Moves pull_tight(const Vec3& direction, double share);
/// The right hand swings the thread about the anchor until it points along `direction`, no further out than it is.
[[nodiscard]] Move swing(const Vec3& direction);
/// Back again until the pull is gone.
[[nodiscard]] Move ease();

}  // namespace ligature::sim
