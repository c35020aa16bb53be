#pragma once
// A knot diagram as a signed Gauss code: what one meets on a walk along the knot.

#include <cstddef>
#include <vector>

namespace ligature::knot {

/// One passage through a crossing.
struct Pass {
  std::size_t crossing;
  bool over;
};

/// 2n passes in order of the walk; each of the n crossings appears once over and once under. sign +1 is a right-handed
/// crossing (over turns counter-clockwise onto under), -1 a left-handed one.
struct Diagram {
  std::vector<Pass> passes;
  std::vector<int> signs;

  [[nodiscard]] std::size_t crossings() const noexcept { return signs.size(); }
};

/// Sum of the signs: +3 for the standard right-handed trefoil.
[[nodiscard]] int writhe(const Diagram& d) noexcept;

/// Removes nugatory crossings (Reidemeister I, and the flip that undoes a crossing between two disjoint halves) and
/// clasps that do not hold (Reidemeister II), until there are none. Keeps the knot type. Cost O(n^3).
void reduce(Diagram& d);

/// The factors that a diagram shows side by side: it is cut wherever a stretch of the walk meets only itself. One
/// entry, the diagram itself, when there is no such stretch. A reduced alternating diagram shows all its factors
/// [Menasco 1984].
[[nodiscard]] std::vector<Diagram> visible_factors(const Diagram& d);

}  // namespace ligature::knot
