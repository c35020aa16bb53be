#pragma once
// A knot in the scene's thread that two hands draw tight at surgeons' speeds. Admission measures with it, because it is
// the typical load of a rig.

#include <array>
#include <functional>
#include <vector>

#include "firmware/physics/simulation.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::app {

/// Speeds of each hand at which admission pulls a knot tight, m/s. Of the recorded hand speeds of surgeons 99.9 % are
/// below 0.25, and all are below 0.4.
inline constexpr std::array<double, 4> kHandSpeeds_m_per_s{0.05, 0.1, 0.25, 0.4};

/// A curve of the thread's length: a loose overhand knot around `middle_W_m` with straight tails along x.
/// @return points in world W, m, much denser than the thread's nodes.
[[nodiscard]] std::vector<scene::Vec> loose_overhand(const scene::Suture& suture, const scene::Vec& middle_W_m);

/// The scene, with its thread cut to at most `nodes` nodes. A thread that is cut keeps its segment length but loses its
/// start shape.
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

/// Steps the thread by one tick, with the work budget and the time limit of a rig.
using Tick = std::function<void(physics::Simulation& thread, const std::array<physics::ToolInput, 2>& tools)>;

/// Grips both ends and moves them apart, each at `speed_m_per_s`. The pull ends when the strain reaches 7 % somewhere,
/// when the ends are 1.3 thread lengths apart, or after 5 s; then the hands hold still for 0.3 s.
/// @param thread made from with_loose_knot()
/// @param tick steps the thread by one tick
[[nodiscard]] DrawnKnot draw(physics::Simulation thread, const scene::Scene& scene, double speed_m_per_s,
                             const Tick& tick);

}  // namespace ligature::app
