#pragma once
// Removes corners of a polyline without changing its knot.

#include <span>
#include <vector>

#include "host/knot/pierce.hpp"

namespace ligature::knot {

/// The first edge of a path that will later close an open polyline: straight, from one end of the polyline to the point
/// `to`. No corner is removed if its triangle is pierced by a bar.
struct Bar {
  bool from_front;  ///< true: starts at the front; false: at the back
  Point to;
};

/// Removes corners (a-b-c becomes a-c) wherever no other edge pierces the triangle, until none is removable. This is an
/// ambient isotopy of the closed polygon, or of the open line together with its bars. The ends of an open line stay.
/// Edges are grouped in blocks with a bounding box each, so that most edges are skipped.
/// @param line corners, no three collinear.
/// Cost O(n^2 / 16 + n k), k the number of edges near a corner; a few passes.
[[nodiscard]] std::vector<Point> with_corners_cut(std::vector<Point> line, bool closed, std::span<const Bar> bars = {});

}  // namespace ligature::knot
