#pragma once
// Fewer corners, the same knot.

#include <span>
#include <vector>

#include "host/knot/pierce.hpp"

namespace ligature::knot {

/// A straight edge that starts at one end of an open line and must not be crossed either: how it will be closed.
struct Bar {
  bool from_front;  ///< else from the back
  Point to;
};

/// Cuts corners off (a-b-c becomes a-c) wherever no other edge pierces the triangle, until none can go: an ambient
/// isotopy of the closed polygon, or of the open line together with its bars. The ends of an open line stay.
/// Edges are kept in blocks with a box around each, so that most of the line is passed over unseen.
/// @param line corners, no three on one line.
/// Cost O(n^2 / 16 + n k), k the edges near a corner; a few passes.
[[nodiscard]] std::vector<Point> with_corners_cut(std::vector<Point> line, bool closed, std::span<const Bar> bars = {});

}  // namespace ligature::knot
