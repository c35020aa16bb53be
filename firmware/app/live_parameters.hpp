#pragma once
// The numbers of a scene that may change while the rig runs, and how far.

#include <string>
#include <vector>

#include "protocol/scene/scene.hpp"

namespace ligature::app {

struct LiveParameter {
  std::string key, name, unit;
  double value, lowest, highest;
};

/// Friction 0 .. 2; the rest from a quarter to four times what the scene file says: beyond that it is another thread,
/// which is another scene. Numbers that are zero in the file, or that its model does not have, are left out.
/// @param file the scene as its file says; @param now as it is.
[[nodiscard]] std::vector<LiveParameter> live_parameters(const scene::Scene& file, const scene::Scene& now);

}  // namespace ligature::app
