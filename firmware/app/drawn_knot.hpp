#pragma once
// A knot in the scene's thread that two hands draw tight at surgeons' speeds: the typical load of a rig, used by
// admission.

#include <array>
#include <functional>
#include <vector>

#include "firmware/physics/simulation.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::app {

/// Speeds of each hand that are measured, m/s. 0.25 covers 99.9 % of the measured speeds of surgeons, 0.4 all of them.
inline constexpr std::array<double, 4> kHandSpeeds_m_per_s{0.05, 0.1, 0.25, 0.4};

/// A loose overhand knot with straight tails along x. Its middle is `middle_W_m`; its length is that of the thread.
/// @return points in world W, m, much denser than the thread's nodes.
[[nodiscard]] std::vector<scene::Vec> loose_overhand(const scene::Suture& suture, const scene::Vec& middle_W_m);

/// The scene itself if its thread has at most `nodes` nodes; else with a shorter thread of the same segment length and
/// no start shape.
[[nodiscard]] scene::Scene no_longer_than(scene::Scene scene, int nodes);

/// The scene with both thread ends free and a loose knot in the thread: the scene's own start shape if it has one and
/// fixes no point, else an overhand knot. The desk is removed, because the knot may lie inside it.
[[nodiscard]] scene::Scene with_loose_knot(scene::Scene scene);

struct DrawnKnot {
  double speed_m_per_s = 0.0;
  double pull_lost = 0.0;  ///< share of time in which the thread was not moved while the hands drew
  double hold_lost = 0.0;  ///< the same share in the next 0.3 s, while the hands held still
  int ticks = 0;
};

/// Steps the thread by one tick with the work budget and the time limit that a rig has.
using Tick = std::function<void(physics::Simulation& thread, const std::array<physics::ToolInput, 2>& tools)>;

/// Grips both ends and moves them apart, each at `speed_m_per_s`, until the strain is 7 % somewhere or the ends are
/// further apart than 1.3 thread lengths; then holds them.
/// @param thread made from with_loose_knot()
/// @param tick steps the thread; the time lost is read from the thread's diagnostics
[[nodiscard]] DrawnKnot draw(physics::Simulation thread, const scene::Scene& scene, double speed_m_per_s,
                             const Tick& tick);

}  // namespace ligature::app
