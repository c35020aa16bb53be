#pragma once
// A small text file as one string: how every reader of scenes, polylines, scripts and records opens its file.

#include <cstddef>
#include <filesystem>
#include <string>
#include <variant>

#include "protocol/scene/scene.hpp"

namespace ligature::scene {

inline constexpr std::size_t kMostScene_bytes = std::size_t{1} << 20;  ///< scenes, device records, fault scripts
inline constexpr std::size_t kMostCsv_bytes = std::size_t{16} << 20;   ///< polylines, gripper scripts

/// Never waits: only a regular file is read, so no pipe, device or terminal, whatever its name leads to.
/// @return the text, or one line that says what is there instead, or how long it may be.
[[nodiscard]] std::variant<std::string, Error> read_text(const std::filesystem::path& path, std::size_t most_bytes);

}  // namespace ligature::scene
