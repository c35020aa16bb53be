#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace ligature::host::view {

/// What a page must know of the scene to draw it, as it runs, with all overrides: {length_m, fixed [[x, y, z] ..],
/// desk_height_m or null, gripper_m: length of the grippers that the thread collides with or null, equal_segments, EA_N
/// or null}. No file is read. Null when the text is no scene.
/// @param recorded_toml text of the scene as recordings have it (protocol/scene/recorded_scene.hpp)
[[nodiscard]] nlohmann::json scene_facts(const std::string& recorded_toml, const std::string& scene_file);

}  // namespace ligature::host::view
