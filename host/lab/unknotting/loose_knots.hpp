#pragma once
// Loosely tied knots to undo: the same script, never twice the same hand.

#include <cstdint>
#include <string>

#include "host/lab/rehearsal.hpp"

namespace ligature::lab {

struct LooseKnot {
  scene::Scene scene;
  physics::Simulation thread;  ///< released, and at rest for three seconds
  std::string type;
  std::uint32_t seed = 0;
};

/// Ties the script's knot with a hand that trembles (each key up to 1.5 cm aside), hurries or dawdles (5 % either way)
/// and lets go; with nodes 35 and 50 in turn. Draws again, from seeds of its own, whenever what came out is not `type`.
/// @param number which one of a series, from 0;  @param drawn counts the tries.
[[nodiscard]] LooseKnot tie_loosely(const std::string& scene_path, const scene::GripperScript& script,
                                    const std::string& type, std::uint32_t number, int& drawn);

}  // namespace ligature::lab
