#pragma once
// The haptics experiment in its parts. Each fills its tables and adds its claims.

#include <filesystem>

#include "host/lab/report.hpp"

namespace ligature::lab {

inline constexpr double kTaut_N = 0.7;  ///< below what an Omni-class device may do for ever

/// How much of it: the quick one is for ctest, the whole one for the docs.
struct HapticsBench {
  std::filesystem::path scenes, out;
  bool quick = false;
  /// Of each hand from the middle when the knotted suture pulls at it by kTaut_N; and with the peg in its way.
  double taut_m = 0.0, taut_at_peg_m = 0.0;
};

void measure_z_width(const HapticsBench& bench, Verdict& v);
void measure_velocity(const HapticsBench& bench, Verdict& v);
void measure_ports(const HapticsBench& bench, Verdict& v);
void measure_fidelity(const HapticsBench& bench, Verdict& v);

}  // namespace ligature::lab
