#pragma once
// The scene parameters that may change while the rig runs, and their ranges.

#include <string>
#include <vector>

#include "protocol/scene/scene.hpp"

namespace ligature::app {

struct LiveParameter {
  std::string key, name, unit;
  double value, lowest, highest;
};

/// Ranges: friction 0 .. 10 as in the paper's Table I, on a rod 0.01 .. 2; every other parameter from a quarter to four
/// times the value in the scene file. Larger changes need another scene. Parameters that are zero in the file, or that
/// its model lacks, are left out.
/// @param file the scene as in its file
/// @param now the scene as it runs
[[nodiscard]] std::vector<LiveParameter> live_parameters(const scene::Scene& file, const scene::Scene& now);

}  // namespace ligature::app
