#pragma once

#include "host/knot/diagram.hpp"
#include "host/knot/laurent.hpp"

namespace ligature::knot {

/// Jones polynomial V(t), V = (-A^3)^(-writhe) <D> at A = t^(-1/4); the right-handed trefoil is t + t^3 - t^4, the
/// mirror image has V(1/t). Kauffman's bracket is summed crossing by crossing over the ways in which the open strands
/// are paired so far, so the cost follows the width of the diagram (at most Catalan(width) pairings), not 2^n.
/// Meant for n <= 40 crossings, where 64-bit coefficients cannot overflow.
[[nodiscard]] Laurent jones(const Diagram& d);

}  // namespace ligature::knot
