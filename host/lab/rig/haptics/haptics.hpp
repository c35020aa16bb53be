#pragma once
// The parts of the haptics experiment. Each writes its tables and adds its claims to the verdict.

#include <cstdint>
#include <filesystem>

#include "host/lab/report.hpp"

namespace ligature::lab {

inline constexpr double kTaut_N = 0.7;  ///< below the continuous force of an Omni-class device

/// Folders and extent of the experiment: quick for ctest, complete for the docs.
struct HapticsBench {
  std::filesystem::path scenes, out;
  bool quick = false;
  /// Distance of each hand from the middle at which the knotted suture pulls with kTaut_N, without and with a peg in
  /// its way.
  double taut_m = 0.0, taut_at_peg_m = 0.0;
  std::uint64_t seed = 1;  ///< of the frame losses
};

void measure_z_width(const HapticsBench& bench, Verdict& v);
void measure_velocity(const HapticsBench& bench, Verdict& v);
void measure_ports(const HapticsBench& bench, Verdict& v);
void measure_fidelity(const HapticsBench& bench, Verdict& v);

}  // namespace ligature::lab
