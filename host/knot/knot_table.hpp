#pragma once
// Names of knots by their invariants.

#include <optional>
#include <string>
#include <vector>

#include "host/knot/laurent.hpp"

namespace ligature::knot {

struct KnotName {
  std::string type;  ///< "3_1", "3_1#4_1": Alexander-Briggs names, parts in rising order
  std::string
      handedness;  ///< "right", "left", "amphichiral", "mixed" (a sum of parts of different hands), "none" (0_1)
};

/// The prime knots up to seven crossings and their sums up to ten. Right is the hand whose reduced alternating diagram
/// has positive writhe (Tait: all such diagrams of one knot agree).
/// @param crossings of the diagram that the invariants came from: a name is given only where no other knot with so few
///        crossings shares both polynomials. 5_1 and 10_132 do, and from eleven crossings on there are too many, so
///        there only the unknot is named, for which the Jones polynomial alone decides up to 24 crossings.
[[nodiscard]] std::optional<KnotName> name_of(const std::vector<int>& alexander, const Laurent& jones,
                                              std::size_t crossings);

/// The name of a sum of two named knots.
[[nodiscard]] KnotName sum_of(const KnotName& a, const KnotName& b);

}  // namespace ligature::knot
