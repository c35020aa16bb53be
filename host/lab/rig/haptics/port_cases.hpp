#pragma once
// What hands do to a thread in the experiment on the device ports: a name, a script, a kind of hand, a kind of trouble.

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
  double stiffness = 1.0;  ///< times the scene's coupling, beyond what is admissible
  std::vector<std::string> overrides = {kWeightless};
  std::function<void(RigSetup&)> trouble = [](RigSetup&) {};
  bool gives_way = false;  ///< one hand is pulled by the other: its port gives out what the other's took in
  bool wild = false;       ///< hands that fight back, wilder than the device record takes them to be: may be let go
  bool unstable_without = false;  ///< without the controller
  bool in_quick = false;
};

[[nodiscard]] std::vector<PortCase> port_cases(const HapticsBench& bench);

/// The knotted suture of scenes/suture-3-0-knot.toml. @param controller of passivity.
[[nodiscard]] Watched play(const HapticsBench& bench, const PortCase& c, bool controller);

}  // namespace ligature::lab
