#pragma once
// Threads for the validation experiments: the same piece of thread in any model; and functions that clamp it, apply its
// weight and run it to rest.

#include <array>
#include <vector>

#include "firmware/physics/simulation.hpp"
#include "host/lab/validate/cases.hpp"
#include "host/lab/validate/proceed.hpp"

namespace ligature::validate {

using physics::Vec3;
using Tools = std::array<physics::ToolInput, 2>;

[[nodiscard]] inline bool is_rod(const scene::Scene& s) noexcept { return s.suture.model == scene::Model::kRod; }

/// Length, density and EI are 1, and EA is so large that stretch changes results by 1e-5 only. Straight along +x from
/// the origin; no gravity, contact, twist or damping except air drag `drag_per_s`. One tick lasts tick_s: ten implicit
/// steps (rod), or as many explicit ones as make_stable() chooses (paper models).
[[nodiscard]] scene::Scene unit_thread(const Subject& subject, double tick_s, double drag_per_s);

/// The thread of scenes/suture-3-0.toml (0.3 mm nylon), or of scenes/paper.toml for a paper model, with `share` of its
/// length (0.3 m or 5 m). Straight along +x from the origin, no gravity, given friction, damping as in the scene.
[[nodiscard]] scene::Scene real_thread(const Subject& subject, double share, double friction);

void set_bending(scene::Scene& scene, double EI_N_m2);
void set_stretch(scene::Scene& scene, double EA_N);
void set_drag(scene::Scene& scene, double per_s);

/// Segment length, m.
[[nodiscard]] inline double segment_m(const scene::Scene& s) noexcept {
  return s.suture.length_m / (s.suture.nodes - 1);
}

/// Holds node 0 at the origin with its tangent along +x. A paper model's clamp fixes two nodes and the thread bends
/// first at the second one, so its free part begins after half a segment.
void clamp_start(scene::Scene& scene);
[[nodiscard]] double clamp_end_m(const scene::Scene& scene);

/// Applies a weight per length w along -axis (1: y, 2: z) as constant loads: each node carries the weight of its part
/// of the thread. Gravity is not used, because all nodes of a paper model have the same mass: its last node, with half
/// a part, would weigh twice as much as its part.
void weigh(scene::Scene& scene, double w_N_per_m, int axis);

/// Lays the thread along a curve: node k at place(s_k).
template <class Place>
void lay(scene::Scene& scene, Place place) {
  scene.suture.initial = "laid";
  scene.suture.initial_polyline_m.clear();
  for (int k = 0; k < scene.suture.nodes; ++k) {
    const Vec3 p = place(scene.suture.length_m * k / (scene.suture.nodes - 1));
    scene.suture.initial_polyline_m.push_back({p.x(), p.y(), p.z()});
  }
}

/// Sets enough substeps to keep an explicit model stable with a margin. Does not cover model 5's stretch.
void make_stable(scene::Scene& scene);

/// Duration of one step, s: for a rod with its regular number of substeps, for a paper model after make_stable().
[[nodiscard]] double step_s(const scene::Scene& scene);

/// @throws std::runtime_error when the physics refuses the scene.
[[nodiscard]] physics::Simulation build(const scene::Scene& scene);

/// Two open hands, far away from the thread.
[[nodiscard]] Tools no_hands();

/// Runs until no node is faster than still_m_per_s. @return false when that takes more than `most` ticks.
bool settle(physics::Simulation& sim, const Tools& tools, double still_m_per_s, int most);

[[nodiscard]] double fastest(const physics::Simulation& sim);

}  // namespace ligature::validate
