#pragma once
// Writhe of a polygon.

#include <vector>

#include "firmware/physics/rod/vec.hpp"

namespace ligature::published {

/// Gauss's double integral over the segments of an open polygon, exact for each pair [Klenin & Langowski, Biopolymers
/// 54 (2000), method 1a]. A curve that ends in two long straight pieces along one line has the writhe of its closure.
[[nodiscard]] double writhe(const std::vector<physics::rod::Vec>& x);

}  // namespace ligature::published
