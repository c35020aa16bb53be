#pragma once
// Cases of the experiment on the device ports: a name, a script, a hand model and a disturbance.

#include <functional>
#include <string>
#include <vector>

#include "host/lab/rig/haptics/bench_run.hpp"
#include "host/lab/rig/haptics/hands.hpp"
#include "host/lab/rig/haptics/haptics.hpp"

namespace ligature::lab {

using Will = std::unique_ptr<sim::Intention>;

struct PortCase {
  std::string name;
  scene::GripperScript script;
  sim::Hand hand{};
  std::function<Will(Will)> wrap = [](Will will) { return will; };
  double frame_loss = 0.0;
  double stiffness = 1.0;  ///< factor on the scene's coupling; above 1 it exceeds the admissible value
  std::vector<std::string> overrides = {kWeightless};
  std::function<void(RigSetup&)> trouble = [](RigSetup&) {};
  /// one hand is dragged by the other: its port delivers the energy that the other one took in
  bool gives_way = false;
  bool wild = false;              ///< the hands fight back harder than the device record assumes; they may be let go
  bool unstable_without = false;  ///< unstable when the passivity controller is off
  bool in_quick = false;
};

[[nodiscard]] std::vector<PortCase> port_cases(const HapticsBench& bench);

/// Runs a case with the knotted suture of scenes/suture-3-0-knot.toml. @param controller whether the passivity
/// controller acts.
[[nodiscard]] Watched play(const HapticsBench& bench, const PortCase& c, bool controller);

}  // namespace ligature::lab
