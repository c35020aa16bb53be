#pragma once
// Reads small text files; used by all readers of scenes, polylines, scripts and records.

#include <cstddef>
#include <filesystem>
#include <string>
#include <variant>

#include "protocol/scene/scene.hpp"

namespace ligature::scene {

inline constexpr std::size_t kMostScene_bytes = std::size_t{1} << 20;  ///< largest scene, device record or fault script
inline constexpr std::size_t kMostCsv_bytes = std::size_t{16} << 20;   ///< largest polyline or gripper script

/// Reads a text file. Never blocks: pipes, devices and terminals are refused, only regular files are read.
/// @return the text, or one line that says why it was refused: not a regular file, unreadable, or too long
[[nodiscard]] std::variant<std::string, Error> read_text(const std::filesystem::path& path, std::size_t most_bytes);

}  // namespace ligature::scene
