#pragma once

#include "firmware/physics/simulation.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::app {

/// What the worst tick costs. Times are CPU time of the measuring thread with cold caches, the smallest of several
/// runs of the same tick (so that other work on the core does not count; that is doctor's matter), the largest of all
/// ticks tried.
struct WorstCase {
  double thread_us = 0.0;   ///< one tick of the thread's physics
  double calls_us = 0.0;    ///< the kernel's part of sending and receiving
  double control_us = 0.0;  ///< control law and record
  bool contact_cap_hit = false;
  physics::Degradation gave_up = physics::Degradation::kNone;  ///< the worst that any of the ticks did to stay bounded
  double time_lost = 0.0;                                      ///< share of such a tick in which the thread stood still
  int most_contacts = 0;
  int ticks = 0;  ///< different ones that were tried
};

/// Tries the scene's worst shapes on the calling thread for so many seconds, and each of them once at least.
/// @param scene one that physics::Simulation::make() accepts.
[[nodiscard]] WorstCase measure_worst_case(const scene::Scene& scene, double seconds);

}  // namespace ligature::app
