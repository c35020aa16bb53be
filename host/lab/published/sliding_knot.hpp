#pragma once
// A long overhand knot of n full turns that is drawn tight slowly, and the quantities of its shape that theories of
// such knots use.

#include "host/lab/published/case.hpp"

namespace ligature::published {

/// The knot to draw. Lengths in units of the thread's radius h.
struct KnotPlan {
  int turns = 1;
  double friction = 0.0;
  double excess_h = 0.0;  ///< thread length less the distance of its ends, at which the knot is measured
  double braid_h = 0.0;   ///< length of the braid as laid; 0: that of a trefoil
  int nodes = 150;
};

/// The drawn knot. Lengths are in units of the thread's radius h, forces in B / h^2 (B: bending stiffness). Values are
/// NaN when the thread is no longer that knot.
struct DrawnKnot {
  double tension = 0.0;         ///< mean over the measured part of the motion
  double change = 0.0;          ///< relative change of the tension within it: about 0 while the knot slides freely
  double peak_curvature = 0.0;  ///< of the loop outside the braid
  double top_curvature = 0.0;   ///< its peak in the half of the loop that is opposite to the braid
  double exit_curvature = 0.0;  ///< of the loop where it leaves the braid
  double wave_number = 0.0;     ///< k of the two strands' helices, middle of the braid
  double contact_length = 0.0;  ///< length of the braid over which the strands touch
  double clearance = 0.0;       ///< mean distance of the strands' centrelines there, less 2 h
};

[[nodiscard]] DrawnKnot draw_knot(const Subject& subject, const KnotPlan& plan);

}  // namespace ligature::published
