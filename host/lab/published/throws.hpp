#pragma once
// The curve of a loose knot of several throws. In each throw the two strands wind about each other by an odd number of
// half turns.

#include <span>
#include <string>
#include <vector>

#include "host/lab/validate/specimen.hpp"

namespace ligature::published {

/// Which of the knot's four ends are the ends of the thread. A long slack loop joins the other two ends of the knot.
enum class Ends {
  kAbove,    ///< both ends above the last throw: square, granny, surgeon's knot
  kDiagonal  ///< one above the last throw, the other below the first one, opposite: thief, grief
};

/// Lengths in units of the thread's diameter d.
struct Throws {
  std::vector<int> half_turns;  ///< of each throw, odd, the first throw first; positive: right-handed
  Ends ends = Ends::kAbove;
  double aside_d = 2.5;      ///< distance of each strand from the throw's axis
  double half_turn_d = 8.0;  ///< along the axis, for each half turn
  double between_d = 12.0;   ///< from one throw's axis to the next
  double rounding_d = 1.5;   ///< width of the Gaussian that rounds the corners; it also narrows the windings
  double loop_d = 250.0;     ///< length of the slack loop
  double tail_d = 60.0;      ///< length of the straight pieces at the thread's ends
};

/// Points along the knot, equally spaced, m. The throws' axes are parallel to x; the ends lead off along -x (first
/// point) and +x (last one).
[[nodiscard]] std::vector<validate::Vec3> curve_of(const Throws& throws, double diameter_m);

/// Rounds a polyline's corners by a Gaussian of this width, and returns points `step` apart. The ends are kept.
[[nodiscard]] std::vector<validate::Vec3> rounded(const std::vector<validate::Vec3>& line, double width, double step);

/// Makes the scene's thread that curve: length and start shape.
void lay_curve(scene::Scene& scene, const std::vector<validate::Vec3>& line);

/// Type, handedness and Alexander polynomial of the thread's knot: equal texts for the same knot.
[[nodiscard]] std::string knot_in(std::span<const validate::Vec3> nodes);

}  // namespace ligature::published
