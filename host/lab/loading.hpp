#pragma once
// Scenes, scripts and simulations for programs that refuse bad input with one line.

#include <string>
#include <vector>

#include "firmware/physics/simulation.hpp"
#include "protocol/scene/gripper_script.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::lab {

/// Reads a scene. @throws Refusal with one line.
[[nodiscard]] scene::Scene load_scene_or_refuse(const std::string& path, const std::vector<std::string>& overrides);

/// load_scene_or_refuse() in two steps (read, parse), for callers that also record the text.
[[nodiscard]] std::string read_scene_text_or_refuse(const std::string& path);
[[nodiscard]] scene::Scene parse_scene_or_refuse(const std::string& text, const std::string& path,
                                                 const std::vector<std::string>& overrides);

/// Reads a script. @throws Refusal with one line.
[[nodiscard]] scene::GripperScript load_script_or_refuse(const std::string& path);

/// Builds the simulation. @throws Refusal with one line, the physics' own reason.
[[nodiscard]] physics::Simulation make_or_refuse(const scene::Scene& scene, const std::string& scene_name);

}  // namespace ligature::lab
