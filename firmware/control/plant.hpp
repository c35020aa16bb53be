#pragma once
// A new simulation with its hand settings, for a change of scene or parameters. It is built outside the loop and handed
// over to it as a whole.

#include <cstdint>

#include "firmware/physics/simulation.hpp"
#include "firmware/rt/handover.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::control {

struct Plant {
  physics::Simulation thread;
  scene::Hands hands;
  /// True: new parameters, with which the suture moves on from its present state. False: another scene, from its start
  bool keeps_motion = false;
  /// Set by the loop to tell whether it accepted the change. False: force may flow, or the parameters do not fit the
  /// suture
  bool taken = false;
  std::int64_t first_tick = -1;  ///< set by the loop: first tick with this plant
};

using PlantHandover = rt::Handover<Plant>;

}  // namespace ligature::control
