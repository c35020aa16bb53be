#pragma once
// Named knots as plans: their throws, and how these are drawn tight.

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "sim_device/operator/throw.hpp"

namespace ligature::sim {

/// A knot that the operator can tie, with its type as host/knot names it.
struct Knot {
  std::string_view name;
  std::string_view type;
  std::string_view handedness;
  std::span<const Throw> throws;
  double least_diameters = 0.0;  ///< minimal length of the thread, in diameters
  /// Longest segment of a paper model's chain, in thread diameters d, for which the knot holds. Segments of length a
  /// that wind round a strand at the distance d from its axis bend by 2 atan(a / 2 d) at each node. In simulations with
  /// a above 1.2 d (1.1 rad) a second turn beside the first slipped off. A single turn held up to a = 2.65 d, the
  /// longest that was tried.
  double longest_segment = 1.2;
};

/// No knot at all: the operator unties the one that it sees (untie.hpp).
inline constexpr Knot kUntie{"untie", "0_1", "none", {}, 0.0, 1e9};

/// The knots that are tied reliably. A surgeon's knot is a first throw of two turns (5_1) and a second of one turn, a
/// trefoil of opposite handedness: together 3_1#5_1. The throws of a square knot are two trefoils of opposite
/// handedness, 3_1#3_1 (amphichiral).
[[nodiscard]] std::span<const Knot> knots();
[[nodiscard]] std::optional<Knot> knot_named(std::string_view name);
/// Names of all knots, separated by ", ", for messages.
[[nodiscard]] std::string knot_names();

/// How many throws of the knot are recognised in the thread as it hangs; nothing if the thread's knot is no part of
/// this knot.
[[nodiscard]] std::optional<std::size_t> throws_seen(const Knot& knot, const Look& look);

/// With empty hands: takes the end, pulls the thread straight however it is entangled, and releases it. A thread that
/// already hangs straight is left alone, because its end may be out of reach.
[[nodiscard]] Moves draw_straight();

/// All moves from empty hands to empty hands. @param first index of the first throw not yet tied
[[nodiscard]] Moves plan(const Knot& knot, const Workplace& place, std::size_t first = 0);

}  // namespace ligature::sim
