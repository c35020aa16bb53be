#pragma once

#include <vector>

#include "host/knot/diagram.hpp"

namespace ligature::knot {

/// Alexander polynomial: coefficients from t^0 up. It is normalised to have no factor t and a positive first
/// coefficient: the trefoil is {1, -1, 1} and the unknot {1}.
/// A minor of the matrix of Fox derivatives, one row a crossing (1 - t, t, -1), is evaluated at n points modulo the
/// prime 2^61 - 1 and interpolated, all in integers. No coefficient exceeds 4^n, so the result is proved exact for n <=
/// 29 crossings; simplify larger diagrams first. Cost O(n^4).
[[nodiscard]] std::vector<int> alexander(const Diagram& d);

/// The knot's determinant |Delta(-1)|. @param alexander coefficients of the Alexander polynomial Delta.
[[nodiscard]] int determinant(const std::vector<int>& alexander) noexcept;

}  // namespace ligature::knot
