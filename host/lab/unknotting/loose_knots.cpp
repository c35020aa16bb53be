#include "host/lab/unknotting/loose_knots.hpp"

#include <random>

#include "host/lab/outcome.hpp"
#include "host/lab/script_moves.hpp"
#include "protocol/scene/random.hpp"

namespace ligature::lab {
namespace {

scene::GripperScript trembling(scene::GripperScript script, std::mt19937& random) {
  for (auto& keys : script.keys) {
    for (auto& key : keys) {
      for (auto& x : key.p_W_m) x += scene::between(random, -0.015, 0.015);
    }
  }
  return paced(std::move(script), scene::between(random, 0.95, 1.05));
}

}  // namespace

LooseKnot tie_loosely(const std::string& scene_path, const scene::GripperScript& script, const std::string& type,
                      std::uint32_t number, int& drawn) {
  constexpr double kRest_s = 3.0;
  constexpr std::uint32_t kTries = 40;
  for (std::uint32_t seed = kTries * number; seed < kTries * (number + 1); ++seed) {
    std::mt19937 random(seed);
    const auto scene = load_scene_or_refuse(scene_path, {number % 2 ? "suture.nodes=35" : "suture.nodes=50"});
    const auto hand = trembling(script, random);
    Rehearsal r(scene, hand);
    ++drawn;
    if (!r.run_until(scene::end_time_s(hand) + kRest_s) || knot_of(r.simulation()).type != type) continue;
    return {scene, std::move(r.simulation()), type, seed};
  }
  throw Refusal("no " + type + " in " + std::to_string(kTries) + " tries with a trembling hand", kRunFailed);
}

}  // namespace ligature::lab
