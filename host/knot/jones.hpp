#pragma once

#include "host/knot/diagram.hpp"
#include "host/knot/laurent.hpp"

namespace ligature::knot {

/// Jones polynomial V(t) = (-A^3)^(-writhe) <D> at A = t^(-1/4). The right-handed trefoil has t + t^3 - t^4; the mirror
/// image has V(1/t). Kauffman's bracket <D> is summed crossing by crossing; the state is the pairing of the strands
/// that are still open. The cost therefore grows with the width of the diagram (at most Catalan(width) pairings), not
/// with 2^n. For n <= 40 crossings 64-bit coefficients cannot overflow.
[[nodiscard]] Laurent jones(const Diagram& d);

}  // namespace ligature::knot
