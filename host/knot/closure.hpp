#pragma once
// An open thread has no knot type until its ends are joined. These are the ways we join them.

#include <span>
#include <vector>

#include "host/knot/polygon.hpp"

namespace ligature::knot {

/// How the ends of a thread are joined: both run straight out, the front along `first`, the back along `last`, to far
/// outside the thread, and meet there along a great circle, which nothing can cross.
/// @param thread two or more points;  @param first, last unit vectors.
/// @return the corners of the way from the thread's back to its front, both left out.
[[nodiscard]] std::vector<Point> way_home(std::span<const Point> thread, const Point& first, const Point& last);

/// The direction from the thread's centre to a point, or up when they coincide.
[[nodiscard]] Point outward(std::span<const Point> thread, const Point& from);

/// k-th of n directions spread evenly over the sphere (a Fibonacci spiral, turned away from the axes).
[[nodiscard]] Point spread_direction(int k, int n);

}  // namespace ligature::knot
