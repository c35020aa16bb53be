#pragma once
// Scene files: TOML in, a checked Scene out, or one line that says what to change.

#include <filesystem>
#include <span>
#include <string>
#include <variant>

#include "protocol/scene/scene.hpp"

namespace ligature::scene {

/// Reads a scene file and then the overrides on top of it, strictly: an unknown key or table, a wrong type, a value out
/// of range, a NaN or an infinity is refused, and nothing is guessed. A key that is left out keeps its default.
/// @param path      the TOML file; a polyline it names is found relative to its folder.
/// @param overrides `key=value`, the key dotted from the root and the value as TOML writes it (a text that is not valid
///                  TOML is taken as a string): `suture.nodes=35`, `world.loads=[{node=-1, force_N=[0,0,-1e-3]}]`.
///                  A polyline named here is found relative to the current folder.
/// @return the scene, or the line "FILE:LINE: key 'suture.nodes': found 1, allowed integer 2 .. 5000"
///         (for an override "--set suture.nodes=1: key 'suture.nodes': ...").
[[nodiscard]] std::variant<Scene, Error> load_scene(const std::filesystem::path& path,
                                                    std::span<const std::string> overrides = {});

/// The same from a text that was read from `path`, so that what is run and what is recorded is one reading.
[[nodiscard]] std::variant<Scene, Error> parse_scene(const std::string& text, const std::filesystem::path& path,
                                                     std::span<const std::string> overrides = {});

/// "paper-4" and the like, as scene files write it.
[[nodiscard]] const char* name(Model model) noexcept;

}  // namespace ligature::scene
