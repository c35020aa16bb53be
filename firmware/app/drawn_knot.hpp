#pragma once
// A knot in the scene's thread, drawn tight by two hands: the work that a rig is for, at the speeds of surgeons' hands.

#include <array>
#include <functional>
#include <vector>

#include "firmware/physics/simulation.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::app {

/// m/s a hand. 0.25 covers 99.9 % of what was measured of surgeons, 0.4 all of it.
inline constexpr std::array<double, 4> kHandSpeeds_m_per_s{0.05, 0.1, 0.25, 0.4};

/// A loose overhand knot with straight tails along x, its middle where the scene's thread begins, as long as the
/// thread.
/// @return points in world W, m, far closer to each other than nodes are.
[[nodiscard]] std::vector<scene::Vec> loose_overhand(const scene::Suture& suture, const scene::Vec& middle_W_m);

/// The scene with a piece of its thread, of the same segments and in no shape of its own, where it has more nodes.
[[nodiscard]] scene::Scene no_longer_than(scene::Scene scene, int nodes);

/// The scene with both ends of its thread free, and a loose knot in it: its own, if it begins with a shape of its own
/// and nothing fixed, else an overhand. The desk is left out: it may be where the knot lies.
[[nodiscard]] scene::Scene with_loose_knot(scene::Scene scene);

struct DrawnKnot {
  double speed_m_per_s = 0.0;
  double pull_lost = 0.0;  ///< share of the time that the thread stood still while the hands drew,
  double hold_lost = 0.0;  ///< and in the 0.3 s after, in which they held
  int ticks = 0;
};

/// A tick of the thread, as it would be on a rig: with the work, or the time, that a rig has for it.
using Tick = std::function<void(physics::Simulation& thread, const std::array<physics::ToolInput, 2>& tools)>;

/// Both ends are taken and drawn apart with `speed` each, until the thread is stretched by 7 % somewhere, or its ends
/// are further apart than any thread may be; then held.
/// @param thread one of with_loose_knot(). @param tick steps it; its diagnostics tell what was lost.
[[nodiscard]] DrawnKnot draw(physics::Simulation thread, const scene::Scene& scene, double speed_m_per_s,
                             const Tick& tick);

}  // namespace ligature::app
