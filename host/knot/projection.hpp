#pragma once
// From a polygon in space to a diagram in a plane.

#include <optional>
#include <span>

#include "host/knot/diagram.hpp"
#include "host/knot/polygon.hpp"

namespace ligature::knot {

/// The diagram that an eye far away along +direction sees.
/// @return nothing when that view is not generic: a corner lies on another edge's image, or two strands touch.
/// Cost O(n^2).
[[nodiscard]] std::optional<Diagram> project(std::span<const Point> corners, const Point& direction);

/// The reduced diagram with the fewest crossings among `views` directions spread over the sphere.
/// @return nothing only when no view was generic (a polygon that touches itself).
[[nodiscard]] std::optional<Diagram> simplest_view(std::span<const Point> corners, int views);

}  // namespace ligature::knot
