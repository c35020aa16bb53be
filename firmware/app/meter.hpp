#pragma once

#include "firmware/physics/simulation.hpp"
#include "protocol/device/device.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::app {

/// CPU times of the loop's work in one tick, measured with cold caches. Each tick runs several times and its shortest
/// time counts, which excludes disturbance by other processes (doctor measures that). Each field is the largest over
/// all ticks tried.
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
/// @param scene one that physics::Simulation::make() accepts. The scene's suture.work_instructions is the contact
/// budget if it is set. Otherwise the budget is measured on this core: 99 % of the ticks in which a knot is drawn tight
/// end in time.
/// @param given_us time available in each period
[[nodiscard]] ThreadCost measure_thread(const scene::Scene& scene, double given_us, double seconds);

/// Steps a thread as a rig does: the tick ends when its contact budget is used up, or after `given_us` of CPU time.
void tick_within(physics::Simulation& thread, const std::array<physics::ToolInput, 2>& tools, double given_us) noexcept;

}  // namespace ligature::app
