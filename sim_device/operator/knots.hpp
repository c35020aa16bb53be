#pragma once
// Named knots as plans: which throws, and how they are drawn tight.

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "sim_device/operator/throw.hpp"

namespace ligature::sim {

/// What an operator can tie, and how host/knot calls it.
struct Knot {
  std::string_view name;
  std::string_view type;
  std::string_view handedness;
  std::span<const Throw> throws;
  double least_diameters = 0.0;  ///< the thread must be so many diameters long
  /// Of a chain's segments, in diameters d. One that lies d off a strand's middle turns by 2 atan(a / 2 d) at each
  /// node, a its segment; beyond a = 1.2 d, 1.1 rad, it holds no second turn beside the first. A single turn is held by
  /// any chain tried, a = 2.65 d.
  double longest_segment = 1.2;
};

/// Those that are tied reliably. A surgeon's knot is a first throw of two turns, 5_1, and a second of one turn, a
/// trefoil of the other hand: their sum 3_1#5_1, as the throws of a square knot are 3_1#3_1 of either hand
/// (amphichiral).
[[nodiscard]] std::span<const Knot> knots();
[[nodiscard]] std::optional<Knot> knot_named(std::string_view name);
/// Their names, parted by ", ", for those who ask.
[[nodiscard]] std::string knot_names();

/// How many of its throws the eye counts in the thread as it hangs; nothing if what it sees is no beginning of it.
[[nodiscard]] std::optional<std::size_t> throws_seen(const Knot& knot, const Look& look);

/// Empty hands take the end, draw the thread straight, however it is entangled, and let it go again. One that hangs
/// straight already is left alone: its end may be lower than an arm reaches.
[[nodiscard]] Moves draw_straight();

/// Everything from empty hands to empty hands. @param first throw that is not tied yet
[[nodiscard]] Moves plan(const Knot& knot, const Workplace& place, std::size_t first = 0);

}  // namespace ligature::sim
