#pragma once
// The scenes that the project ships.

#include <string>
#include <variant>

#include "ligature_source_dir.hpp"
#include "protocol/scene/scene_file.hpp"

namespace ligature {

inline const std::string kScenes = std::string(LIGATURE_SOURCE_DIR) + "/scenes/";

inline scene::Scene paper() { return std::get<scene::Scene>(scene::load_scene(kScenes + "paper.toml")); }

}  // namespace ligature
