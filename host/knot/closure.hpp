#pragma once
// An open thread has no knot type until its ends are joined. This file offers ways to join them.

#include <span>
#include <vector>

#include "host/knot/polygon.hpp"

namespace ligature::knot {

/// Closes an open thread: both ends run straight out, the front along `first`, the back along `last`, to a sphere far
/// outside the thread, and are joined there along a great circle. That circle cannot cross the thread.
/// @param thread two or more points;  @param first, last unit vectors.
/// @return the corners of the closing path from the thread's back to its front, without these two end points.
[[nodiscard]] std::vector<Point> way_home(std::span<const Point> thread, const Point& first, const Point& last);

/// Unit vector from the thread's centre to a point; up when the two coincide.
[[nodiscard]] Point outward(std::span<const Point> thread, const Point& from);

/// The k-th of n directions spread evenly over the sphere (a Fibonacci spiral, rotated away from the axes).
[[nodiscard]] Point spread_direction(int k, int n);

}  // namespace ligature::knot
