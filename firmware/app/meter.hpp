#pragma once

#include "firmware/physics/simulation.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::app {

/// Times are CPU time of the measuring thread with cold caches, the smallest of several runs of the same tick (so that
/// other work on the core does not count; that is doctor's matter), the largest of all ticks tried.
struct LoopCost {
  double calls_us = 0.0;    ///< the kernel's part of sending and receiving
  double control_us = 0.0;  ///< control law and record
};

/// The thread's physics in the scene's worst shapes.
struct ThreadCost {
  double given_us = 0.0;         ///< what it has of each period
  double worst_us = 0.0;         ///< of a tick
  long work = 0;                 ///< instructions that contact may take in a tick; 0: a model without such a bound
  double time_lost = 0.0;        ///< share of the time that it stood still, in the shape in which that was most
  bool ended_by_clock = false;   ///< a tick of those
  bool contact_cap_hit = false;  ///< more contacts than there was room or work for
  int most_contacts = 0;
  int ticks = 0;  ///< different ones that were tried
};

/// On the calling thread, some tenths of a second.
[[nodiscard]] LoopCost measure_loop(const scene::Scene& scene);

/// Tries the worst shapes for so many seconds, and each of them once at least. @param given_us of each period.
/// @param scene one that physics::Simulation::make() accepts; its suture.work_instructions are taken as they are, else
/// they are chosen by what they cost on this core while a knot is drawn, so that such a tick ends before its time is
/// over.
[[nodiscard]] ThreadCost measure_thread(const scene::Scene& scene, double given_us, double seconds);

/// Steps a thread as a rig would that gives it so much work or, where its model knows none, so much CPU time.
void tick_within(physics::Simulation& thread, const std::array<physics::ToolInput, 2>& tools, double given_us) noexcept;

}  // namespace ligature::app
