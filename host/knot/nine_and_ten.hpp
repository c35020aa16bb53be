#pragma once
// The prime knots of nine and ten crossings by their polynomials.

#include <string>
#include <vector>

#include "host/knot/laurent.hpp"

namespace ligature::knot {

/// The prime knots of nine and ten crossings, but of at most `crossings`, that have both polynomials; the Jones
/// polynomial may be that of the mirror image. Cost: a comparison for each of 214 rows; none below nine crossings.
[[nodiscard]] std::vector<std::string> of_nine_and_ten(const std::vector<int>& alexander, const Laurent& jones,
                                                       std::size_t crossings);

}  // namespace ligature::knot
