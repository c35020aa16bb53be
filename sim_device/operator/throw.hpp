#pragma once
// A throw: its specification, and the check whether it is tied.

#include "sim_device/operator/move.hpp"

namespace ligature::sim {

/// How the end turns and how it passes through the loop.
struct Throw {
  int side = 1;          ///< +1: one turn makes a right-handed trefoil; -1: the mirror image in y
  bool against = false;  ///< through the loop against the turn (figure-eight) instead of with it
  int passes = 1;        ///< turns around the standing part (2: a surgeon's first throw)
  int tied_already = 1;  ///< product of the determinants of the throws tied before (diagram.hpp)
};

/// Factor of the knot determinant that is due to this throw: 2 n + 1 for n turns (a torus knot of 2 n + 1 half turns),
/// 5 for a figure-eight.
[[nodiscard]] int determinant_of(const Throw& t);
/// Whether the thread would hold this throw and all before it, if both ends were led away along `out` (diagram.hpp).
[[nodiscard]] bool would_hold(const Look& look, const Throw& t, const Vec3& out);

}  // namespace ligature::sim
