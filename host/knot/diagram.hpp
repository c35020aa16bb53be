#pragma once
// A knot diagram as a signed Gauss code: the crossings in the order of a walk along the knot.

#include <cstddef>
#include <vector>

namespace ligature::knot {

/// One passage of the walk through a crossing.
struct Pass {
  std::size_t crossing;
  bool over;
};

/// 2n passes in the order of the walk; each of the n crossings occurs once over and once under. Sign +1: right-handed
/// crossing (over turns counter-clockwise onto under); -1: left-handed.
struct Diagram {
  std::vector<Pass> passes;
  std::vector<int> signs;

  [[nodiscard]] std::size_t crossings() const noexcept { return signs.size(); }
};

/// Sum of the signs: +3 for the standard right-handed trefoil.
[[nodiscard]] int writhe(const Diagram& d) noexcept;

/// Removes nugatory crossings (Reidemeister I, and the flip of one side of a crossing that separates the diagram) and
/// pairs of crossings that cancel (Reidemeister II), until there are none. The knot type stays. Cost O(n^3).
void reduce(Diagram& d);

/// Splits a composite diagram into factors, wherever a stretch of the walk crosses only itself. Returns one entry, the
/// diagram itself, when there is no such stretch. A reduced alternating diagram shows all its factors this way [Menasco
/// 1984].
[[nodiscard]] std::vector<Diagram> visible_factors(const Diagram& d);

}  // namespace ligature::knot
