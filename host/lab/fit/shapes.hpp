#pragma once
// Closed-form mechanics of a thread that is clamped at one end and bends under its own weight.

namespace ligature::fit {

/// Sag of the tip, divided by the length L, of a thread that is clamped horizontally and bends under its weight w per
/// length.
/// @param load  w L^3 / EI, above 0. The sag is load / 8 for small loads and nears 1 for large ones.
[[nodiscard]] double sag_over_length(double load);

/// Slowest swing of a thread that hangs straight down from a clamp.
struct Swing {
  double period_s = 0.0;     ///< of a full swing; not finite when the thread only creeps back
  double decay_per_s = 0.0;  ///< the amplitude falls as exp(-decay t)
};
struct Hanging {
  double length_m, EI_N_m2, density_kg_per_m, damping_s, drag_per_s;
};
[[nodiscard]] Swing swing_of(const Hanging& thread);

}  // namespace ligature::fit
