#pragma once
// The haptics experiment in its parts. Each fills its tables and adds its claims.

#include <filesystem>

#include "host/lab/report.hpp"

namespace ligature::lab {

/// How much of it: the quick one is for ctest, the whole one for the docs.
struct HapticsBench {
  std::filesystem::path scenes, out;
  bool quick = false;
};

void measure_z_width(const HapticsBench& bench, Verdict& v);
void measure_velocity(const HapticsBench& bench, Verdict& v);
void measure_ports(const HapticsBench& bench, Verdict& v);
void measure_fidelity(const HapticsBench& bench, Verdict& v);

}  // namespace ligature::lab
