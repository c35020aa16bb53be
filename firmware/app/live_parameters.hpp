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

/// The parameters that may change during a run, with their ranges. Friction: 0 to 10 for the paper's models (the
/// paper's Table I), 0.01 to 2 for a rod. Every other parameter: from a quarter to four times its value in the scene
/// file; larger changes need another scene. Parameters that are zero in the file, or that the thread's model does not
/// have, are left out.
/// @param file the scene as in its file
/// @param now the scene as it runs
[[nodiscard]] std::vector<LiveParameter> live_parameters(const scene::Scene& file, const scene::Scene& now);

}  // namespace ligature::app
