#pragma once

#include "firmware/physics/simulation.hpp"
#include "protocol/device/device.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::app {

/// CPU times of the measuring thread with cold caches. Each tick is run several times and its shortest time counts:
/// this excludes disturbance by other processes, which doctor measures. Each field is the largest over all ticks tried.
struct LoopCost {
  double calls_us = 0.0;    ///< kernel calls that send and receive frames
  double control_us = 0.0;  ///< control law and tick record
};

/// Cost of the thread's physics in the scene's worst-case shapes.
struct ThreadCost {
  double given_us = 0.0;         ///< time available in each period
  double worst_us = 0.0;         ///< costliest tick
  long work = 0;                 ///< contact budget per tick, in instructions; 0: the model has no such budget
  double time_lost = 0.0;        ///< largest share of time, over all shapes, in which the thread was not moved
  bool ended_by_clock = false;   ///< at least one tick ended at the deadline
  bool contact_cap_hit = false;  ///< more contacts than the list or the budget could hold
  int most_contacts = 0;
  int ticks = 0;  ///< number of different ticks measured
};

/// Runs on the calling thread and takes some tenths of a second.
[[nodiscard]] LoopCost measure_loop(const scene::Scene& scene, const device::Device& device);

/// Measures ticks of the thread in its worst-case shapes (worst_case.hpp) for `seconds`, each shape at least once.
/// @param scene one that physics::Simulation::make() accepts. Its suture.work_instructions is used if set; else the
/// budget is chosen by its measured cost on this core while a knot is tightened, so that 99 % of these ticks end
/// before the deadline.
/// @param given_us time available in each period
[[nodiscard]] ThreadCost measure_thread(const scene::Scene& scene, double given_us, double seconds);

/// Steps a thread as a rig does: its contact budget or, after `given_us` of CPU time, the clock ends the tick.
void tick_within(physics::Simulation& thread, const std::array<physics::ToolInput, 2>& tools, double given_us) noexcept;

}  // namespace ligature::app
