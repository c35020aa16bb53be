#pragma once
// Runs a simulated operator whose hands move the simulated thread directly, without haptic devices and CAN.

#include <array>
#include <string>
#include <vector>

#include "firmware/physics/simulation.hpp"
#include "ligature_source_dir.hpp"
#include "protocol/scene/scene_file.hpp"
#include "sim_device/operator/knot_tier.hpp"
#include "tests/support/knot_in.hpp"

namespace ligature::sim::test {

using ligature::test::knot_in;
using ligature::test::recognised;

/// Lets the operator tie `knot`; stops when the move `until` begins.
/// @return the knot's type and handedness at the end, or why there is none.
inline std::string tied(const char* name, const char* knot, std::uint32_t seed,
                        const std::vector<std::string>& overrides = {}, const char* until = "done") {
  const auto read = scene::load_scene(std::string(LIGATURE_SOURCE_DIR "/scenes/") + name, overrides);
  if (const auto* error = std::get_if<scene::Error>(&read)) return error->text;
  const auto& scene = std::get<scene::Scene>(read);
  auto made = physics::Simulation::make(scene);
  auto tier = KnotTier::make(scene, knot, seed);
  if (const auto* why = std::get_if<std::string>(&tier)) return *why;
  auto& thread = std::get<physics::Simulation>(made);
  auto& person = std::get<KnotTier>(tier);
  Sight sight;
  for (int k = 0; k < 200'000 && person.doing() != until; ++k) {
    sight.t_s = 1e-3 * k;
    sight.thread_W = thread.nodes_W();
    for (std::size_t h = 0; h < 2; ++h) {
      sight.tool_W[h] = person.wish()[h].p_W;
      const auto& hand = thread.hand(static_cast<physics::Hand>(h));
      sight.force_W_N[h] = hand.f_W;
      sight.holds[h] = hand.node >= 0;
    }
    const auto& wish = person.tick(sight);
    thread.tick({physics::ToolInput{wish[0].p_W, wish[0].v_W, wish[0].grip},
                 physics::ToolInput{wish[1].p_W, wish[1].v_W, wish[1].grip}});
  }
  if (person.doing() != until) return "not done";
  return knot_in(thread.nodes_W());
}

}  // namespace ligature::sim::test
