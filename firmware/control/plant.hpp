#pragma once
// What a change of scene or live parameters replaces in the loop; built in another thread and handed over as a whole.

#include <cstdint>

#include "firmware/physics/simulation.hpp"
#include "firmware/rt/handover.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::control {

struct Plant {
  physics::Simulation thread;
  scene::Hands hands;
  /// True: new parameters, the thread continues from its present state; false: another scene, from its start
  bool keeps_motion = false;
  /// Set by the loop; false: refused, because force may flow or the parameters do not fit the thread
  bool taken = false;
  std::int64_t first_tick = -1;  ///< set by the loop: first tick with this plant
};

using PlantHandover = rt::Handover<Plant>;

}  // namespace ligature::control
