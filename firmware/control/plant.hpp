#pragma once
// A new simulation with the settings of its hands, for a change of scene or parameters. It is built outside the
// real-time loop and handed over to the loop as a whole. Afterwards the loop gives it back, and with it the old
// simulation if the change was accepted.

#include <cstdint>

#include "firmware/physics/simulation.hpp"
#include "firmware/rt/handover.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::control {

struct Plant {
  physics::Simulation thread;
  scene::Hands hands;
  /// True: the same scene with new parameters; the suture moves on from its present state. False: another scene, which
  /// begins at its start
  bool keeps_motion = false;
  /// Whether the change was accepted; set before the plant is given back. A new scene is refused by the loop if force
  /// may flow. New parameters are refused by the physics if the model or the number of nodes is not that of the suture
  /// that runs (Simulation::continue_from())
  bool taken = false;
  std::int64_t first_tick = -1;  ///< set by the loop: first tick with this plant
};

using PlantHandover = rt::Handover<Plant>;

}  // namespace ligature::control
