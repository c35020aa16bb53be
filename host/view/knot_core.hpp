#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "host/knot/recognise.hpp"

namespace ligature::host::view {

/// A part of the thread: nodes first .. last, inclusive; both 0 when there is no knot.
struct KnotCore {
  std::size_t first = 0, last = 0;
};

/// Finds a short piece of the thread that contains the knot: cuts both ends off while the rest keeps the same knot, by
/// two bisections, about 2 log2(n) recognitions. The piece is not always the shortest, because the knot type can change
/// back and forth while a loose, tangled thread is cut.
[[nodiscard]] KnotCore find_core(std::span<const std::array<double, 3>> points, const knot::KnotResult& whole);

/// Finds the throws of a knot that is a sum (3_1#3_1: two throws in a row along the thread): one short piece for each
/// summand, without the thread between them. @return in order along the thread; the core alone when the knot is no sum,
/// or when its throws are stacked, so that no piece of the thread contains one of them alone.
[[nodiscard]] std::vector<KnotCore> find_throws(std::span<const std::array<double, 3>> points,
                                                const knot::KnotResult& whole, KnotCore core);

}  // namespace ligature::host::view
