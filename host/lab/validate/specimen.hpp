#pragma once
// Threads for experiments: the same piece of thread in any model, and what holds, weighs and settles it.

#include <array>
#include <vector>

#include "firmware/physics/simulation.hpp"
#include "host/lab/validate/cases.hpp"
#include "host/lab/validate/proceed.hpp"

namespace ligature::validate {

using physics::Vec3;
using Tools = std::array<physics::ToolInput, 2>;

[[nodiscard]] inline bool is_rod(const scene::Scene& s) noexcept { return s.suture.model == scene::Model::kRod; }

/// Length, density and EI 1, EA so large that its share of any result is 1e-5; straight along +x from the origin; no
/// gravity, contact, twist or damping but air drag `drag_per_s`. One tick lasts tick_s, in ten implicit steps (rod) or
/// as many explicit ones as make_stable() finds (paper models).
[[nodiscard]] scene::Scene unit_thread(const Subject& subject, double tick_s, double drag_per_s);

/// The thread of scenes/suture-3-0.toml (0.3 mm nylon), or of scenes/paper.toml for a paper model, of another length
/// (of 0.3 m or 5 m: `share`); straight along +x from the origin, no gravity, friction as given, shipped damping.
[[nodiscard]] scene::Scene real_thread(const Subject& subject, double share, double friction);

void set_bending(scene::Scene& scene, double EI_N_m2);
void set_stretch(scene::Scene& scene, double EA_N);
void set_drag(scene::Scene& scene, double per_s);

/// Segment length, m.
[[nodiscard]] inline double segment_m(const scene::Scene& s) noexcept {
  return s.suture.length_m / (s.suture.nodes - 1);
}

/// Holds node 0 at the origin with its tangent along +x. A paper clamp pins two nodes and bends first at the second, so
/// the free part begins half a segment along.
void clamp_start(scene::Scene& scene);
[[nodiscard]] double clamp_end_m(const scene::Scene& scene);

/// Weight per length w, downwards along -axis (1: y, 2: z), as a dead load on every node for its share of the thread. A
/// paper model's own masses are equal, so its last node would weigh twice its share.
void weigh(scene::Scene& scene, double w_N_per_m, int axis);

/// Lays the thread out: node k at place(s_k).
template <class Place>
void lay(scene::Scene& scene, Place place) {
  scene.suture.initial = "laid";
  scene.suture.initial_polyline_m.clear();
  for (int k = 0; k < scene.suture.nodes; ++k) {
    const Vec3 p = place(scene.suture.length_m * k / (scene.suture.nodes - 1));
    scene.suture.initial_polyline_m.push_back({p.x(), p.y(), p.z()});
  }
}

/// At least as many substeps as keep an explicit model well inside its stability limit, but for model 5's stretch.
void make_stable(scene::Scene& scene);

/// How long one step lasts, s: of a rod that does not labour, of a paper model made stable.
[[nodiscard]] double step_s(const scene::Scene& scene);

/// @throws std::runtime_error when the physics refuses the scene.
[[nodiscard]] physics::Simulation build(const scene::Scene& scene);

/// Open hands, far away.
[[nodiscard]] Tools no_hands();

/// Ticks until no node is faster than still_m_per_s. @return false when that takes more than `most` ticks.
bool settle(physics::Simulation& sim, const Tools& tools, double still_m_per_s, int most);

[[nodiscard]] double fastest(const physics::Simulation& sim);

}  // namespace ligature::validate
