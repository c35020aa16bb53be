#pragma once
// The prime knots of nine and ten crossings by their polynomials.

#include <string>
#include <vector>

#include "host/knot/laurent.hpp"

namespace ligature::knot {

/// The prime knots of nine and ten crossings (no more than `crossings`) that have both polynomials, or whose mirror
/// image has them. Cost: 214 comparisons; none if `crossings` is below nine.
[[nodiscard]] std::vector<std::string> of_nine_and_ten(const std::vector<int>& alexander, const Laurent& jones,
                                                       std::size_t crossings);

}  // namespace ligature::knot
