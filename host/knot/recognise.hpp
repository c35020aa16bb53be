#pragma once
// Which knot is in this thread?

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "host/knot/laurent.hpp"

namespace ligature::knot {

struct KnotResult {
  std::string type;            ///< "0_1", "3_1", "3_1#3_1", ..; "unknown" when the table does not decide
  std::string handedness;      ///< "right", "left", "amphichiral", "mixed", "none"; the right trefoil has writhe +3
  int determinant = 1;         ///< |Delta(-1)|; says nothing when alexander is empty
  std::vector<int> alexander;  ///< from t^0 up, first coefficient positive; empty when nothing could be computed
  Laurent jones;
  std::size_t crossings = 0;  ///< of the simplest diagram found; the crossing number of the named knots, as a rule
};

/// Names the knot of a polyline.
/// The polyline is simplified by triangle moves, seen from many directions, and the diagram with the fewest crossings
/// gives the Alexander and the Jones polynomial, which name the knot or leave it "unknown": nothing is guessed.
/// What rounding cannot tell is never taken for free: neither a move nor a crossing (pierce.hpp, projection.cpp).
/// An open thread is closed in several ways (both ends outwards from the centre; both towards a common direction); two
/// more that agree with the first settle it, else the majority of nine does.
/// @param points m, in order; fewer than four are the unknot, a point that is not finite gives "unknown", and
///               so do points so far from the origin that rounding has eaten their shape (all in one point, say), and a
///               closed line that lies several times in itself.
/// @param closed whether the last point is joined to the first (a repeated first point at the end does no harm).
/// What is not named by one course of random moves is tried by others (each from a seed of its own), where a diagram of
/// 14 crossings or fewer says that a name may be near. Deterministic, and the same with every build. Cost about
/// O(n^2 / 16): about 1 ms at n = 500 (Knots.Cost bounds the instructions).
[[nodiscard]] KnotResult recognise(std::span<const std::array<double, 3>> points, bool closed);

}  // namespace ligature::knot
