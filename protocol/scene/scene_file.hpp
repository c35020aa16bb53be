#pragma once
// Scene files: reads TOML and returns a checked Scene, or one line that says what to change.

#include <filesystem>
#include <span>
#include <string>
#include <variant>

#include "protocol/scene/scene.hpp"

namespace ligature::scene {

/// Reads a scene file and applies overrides, strictly: unknown keys or tables, wrong types, values out of range, NaN
/// and infinity are refused. A missing key keeps its default.
/// @param path      the TOML file; a polyline that it names is searched relative to its folder
/// @param overrides `key=value` with a dotted key and a TOML value (text that is not valid TOML counts as a string):
/// `suture.nodes=35`, `world.loads=[{node=-1, force_N=[0,0,-1e-3]}]`. A polyline named here is searched relative to the
/// current folder.
/// @return the scene, or the line "FILE:LINE: key 'suture.nodes': found 1, allowed integer 2 .. 5000" (for an override
/// "--set suture.nodes=1: key 'suture.nodes': ...")
[[nodiscard]] std::variant<Scene, Error> load_scene(const std::filesystem::path& path,
                                                    std::span<const std::string> overrides = {});

/// As load_scene(), for a text that was already read from `path`: so the scene that is run is the one that is recorded.
[[nodiscard]] std::variant<Scene, Error> parse_scene(const std::string& text, const std::filesystem::path& path,
                                                     std::span<const std::string> overrides = {});

/// Name in scene files, such as "paper-4".
[[nodiscard]] const char* name(Model model) noexcept;

}  // namespace ligature::scene
