#pragma once
// Names knots by their polynomial invariants.

#include <optional>
#include <string>
#include <vector>

#include "host/knot/laurent.hpp"

namespace ligature::knot {

struct KnotName {
  std::string type;  ///< "3_1", "3_1#4_1": Alexander-Briggs names; the parts of a sum in rising order
  /// "right", "left", "amphichiral", "mixed" (a sum of parts of different hands), "none" (0_1)
  std::string handedness;
};

/// Table of the prime knots up to eight crossings and of all sums up to ten. "right" is the form whose reduced
/// alternating diagram has positive writhe (Tait: all such diagrams of one knot agree). 8_4 has writhe 0, and 8_19 to
/// 8_21 have no alternating diagram: for these "right" is the form in whose Jones polynomial the lowest and the highest
/// exponent have a positive sum. For every other chiral knot of the table both rules agree.
/// @param crossings of the diagram from which the invariants were computed. A name is returned only when no other knot
/// with at most so many crossings has both polynomials (5_1 and 10_132 share them). From eleven crossings on only the
/// unknot is named: its Jones polynomial is unique up to 24 crossings.
[[nodiscard]] std::optional<KnotName> name_of(const std::vector<int>& alexander, const Laurent& jones,
                                              std::size_t crossings);

/// All knots with at most `crossings` crossings that have both polynomials, or whose mirror image has them: one of them
/// is the knot. Empty from eleven crossings on, where the tables end.
[[nodiscard]] std::vector<std::string> candidates(const std::vector<int>& alexander, const Laurent& jones,
                                                  std::size_t crossings);

/// The name of a sum of two named knots.
[[nodiscard]] KnotName sum_of(const KnotName& a, const KnotName& b);

}  // namespace ligature::knot
