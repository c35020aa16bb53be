#pragma once
// Projects a closed polygon to a knot diagram.

#include <optional>
#include <span>

#include "host/knot/diagram.hpp"
#include "host/knot/polygon.hpp"

namespace ligature::knot {

/// The diagram of the parallel projection, seen from far away along +direction.
/// @return nothing when the projection is not generic: a corner lies on another edge's image, or two strands touch.
/// Cost O(n^2).
[[nodiscard]] std::optional<Diagram> project(std::span<const Point> corners, const Point& direction);

/// The reduced diagram with the fewest crossings among `views` directions spread over the sphere.
/// @return nothing only when no view was generic (a polygon that touches itself).
[[nodiscard]] std::optional<Diagram> simplest_view(std::span<const Point> corners, int views);

}  // namespace ligature::knot
