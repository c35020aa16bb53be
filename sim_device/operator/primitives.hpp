#pragma once
// Basic moves, independent of the knot: take, let go, carry, wait, hang out, pull tight, swing, ease. Each uses the
// thread's present shape, by arc length and never by node number.

#include "sim_device/operator/move.hpp"

namespace ligature::sim {

/// The tip approaches place `s` of the thread from the front (-y), follows it until it is between the jaws, and closes
/// them. If they hold nothing, they open and the move repeats. If the place cannot be reached for 3 s (a hanging end
/// may be out of reach), a place slightly closer to the anchor is tried.
[[nodiscard]] Move take(std::size_t hand, const WhereAlong& s);
/// Opens the jaws, waits for that, and backs off to the front.
[[nodiscard]] Move let_go(std::size_t hand);
/// Moves to a goal that may change. The move is done within `near` times Workplace::clearance_m of the goal. @param
/// pace factor on the full speed
[[nodiscard]] Move carry(std::size_t hand, std::string name, const Where& where, double near = 0.5, double pace = 1.0);
/// Waits.
[[nodiscard]] Move wait(double seconds);
/// Waits until the end of the hanging thread no longer swings.
[[nodiscard]] Move hang_out();
/// The right hand moves away from the anchor along `direction` until its force is `share` times that at which a knot is
/// tight.
[[nodiscard]] Moves pull_tight(const Vec3& direction, double share);
/// The right hand swings the thread about the anchor until it points along `direction`, at no larger distance than
/// before.
[[nodiscard]] Move swing(const Vec3& direction);
/// The right hand moves back until the pull is gone.
[[nodiscard]] Move ease();
/// `moves`, or none of them if `needless` is true when the first one starts. A move that is left out does not count as
/// failed.
[[nodiscard]] Moves unless(const std::function<bool(const Look&)>& needless, Moves moves);

}  // namespace ligature::sim
