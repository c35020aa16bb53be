#pragma once
// Names the knot in a thread.

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "host/knot/laurent.hpp"

namespace ligature::knot {

struct KnotResult {
  std::string type;        ///< "0_1", "3_1", "3_1#3_1", ..; "unknown" when no entry of the table is certain
  std::string handedness;  ///< "right", "left", "amphichiral", "mixed", "none"; the right-handed trefoil has writhe +3
  int determinant = 1;     ///< of the knot, |Delta(-1)|; meaningless when alexander is empty
  std::vector<int> alexander;  ///< polynomial: coefficients from t^0 up, the first one positive; empty: not computed
  Laurent jones;
  std::size_t crossings = 0;  ///< of the simplest diagram found; for a named knot usually its crossing number
  /// For "unknown" with a diagram of at most ten crossings: every knot of so few crossings that has these polynomials,
  /// either hand. With one entry the knot is that one.
  std::vector<std::string> candidates;
};

/// Names the knot of a polyline.
/// The polyline is simplified by triangle moves and projected in many directions. The diagram with the fewest crossings
/// gives the Alexander and the Jones polynomial. They select a name from the table, or the result is "unknown"; the
/// function never guesses. Moves and crossings that are uncertain by rounding are rejected (pierce.hpp,
/// projection.cpp).
/// An open thread is closed in several ways (both ends outwards from the centre; both in a common direction). If the
/// first three results agree, they decide; else the majority of all nine does.
/// @param points m, in order. Fewer than four give the unknot. The result is "unknown" for a point that is not finite,
/// for points so far from the origin that rounding has destroyed their shape, and for a closed line that overlaps
/// itself along its length.
/// @param closed whether the last point is joined to the first (a repeated first point at the end is allowed).
/// While no name is found, at least three sequences of random moves with different seeds are tried, and twelve if the
/// best diagram has at most 14 crossings. Deterministic, and equal for every build. Cost about O(n^2 / 16): about 1 ms
/// at n = 500 (the test Knots.Cost bounds the instructions).
[[nodiscard]] KnotResult recognise(std::span<const std::array<double, 3>> points, bool closed);

}  // namespace ligature::knot
