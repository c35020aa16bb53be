#pragma once
// Parses TOML text into a tree, for readers of scene, device and fault files.

#include <filesystem>
#include <string>
#include <string_view>
#include <variant>

#include "protocol/scene/strict_table.hpp"

namespace ligature::scene {

/// First line with a non-ASCII byte outside comments; 0: none. Such bytes are refused because toml++ 3.0 has undefined
/// behaviour for some of them, even within quotes (U+031B, found by fuzzing). In strings they can be written as
/// escapes: "\u00e9".
[[nodiscard]] int line_of_stray_character(std::string_view text);

/// Limit for dots in a key and for nested brackets, because toml++ recurses for each.
inline constexpr std::size_t kDeepest = 8;

/// First line that exceeds kDeepest; 0: none.
[[nodiscard]] int line_too_deep(std::string_view text);

/// @param name of the source, for messages. @return the tree, or one line that names the source and the line of the
/// error.
[[nodiscard]] std::variant<toml::table, Error> parse_toml(const std::string& text, const std::string& name);

/// Parses the TOML text of a file; result as parse_toml().
[[nodiscard]] std::variant<toml::table, Error> parse_toml_file(const std::filesystem::path& path);

}  // namespace ligature::scene
