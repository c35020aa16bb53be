#pragma once
// Named knots as plans: which throws, and how they are drawn tight.

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "sim_device/operator/primitives.hpp"

namespace ligature::sim {

/// What an operator can tie, and how host/knot calls it.
struct Knot {
  std::string_view name;
  std::string_view type;
  std::span<const Throw> throws;
};

/// Those that are tied reliably: overhand.
[[nodiscard]] std::span<const Knot> knots();
[[nodiscard]] std::optional<Knot> knot_named(std::string_view name);

/// Everything from empty hands to empty hands.
[[nodiscard]] Moves plan(const Knot& knot, const Workplace& place);

}  // namespace ligature::sim
