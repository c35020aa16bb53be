#pragma once
// What a change of scene or of live parameters replaces in the loop, built elsewhere and handed over whole.

#include <cstdint>

#include "firmware/physics/simulation.hpp"
#include "firmware/rt/handover.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::control {

struct Plant {
  physics::Simulation thread;
  scene::Hands hands;
  bool keeps_motion = false;  ///< parameters: the thread goes on from where it is; else another scene, from its start
  bool taken = false;         ///< set by the loop; false: it was in a state in which force may flow
  std::int64_t first_tick = -1;  ///< set by the loop: the first that it is in force in
};

using PlantHandover = rt::Handover<Plant>;

}  // namespace ligature::control
