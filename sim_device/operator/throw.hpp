#pragma once
// A throw as such: what is to be made, and whether it is.

#include "sim_device/operator/move.hpp"

namespace ligature::sim {

/// How a turn is laid and how the end goes through.
struct Throw {
  int side = 1;          ///< +1: one turn makes a right-handed trefoil; -1: its mirror image in y
  bool against = false;  ///< through the loop against the turn (figure-eight) instead of with it
  int passes = 1;        ///< how often the end goes round the loop's edge (2: a surgeon's first throw)
  int tied_already = 1;  ///< determinant of the throws before it on the thread (diagram.hpp)
};

/// What a throw multiplies the thread's determinant by: n turns make a torus knot of 2 n + 1 half turns.
[[nodiscard]] int determinant_of(const Throw& t);
/// With both ends led away along `out`, would the thread hold this throw and all before it? (diagram.hpp)
[[nodiscard]] bool would_hold(const Look& look, const Throw& t, const Vec3& out);

}  // namespace ligature::sim
