#pragma once
// TOML text to a tree, for the readers of scene, device and fault files.

#include <filesystem>
#include <string>
#include <string_view>
#include <variant>

#include "protocol/scene/strict_table.hpp"

namespace ligature::scene {

/// The first line with a byte outside ASCII that is not in a comment; 0 when there is none. toml++ 3.0 looks whether
/// such a character is a space, in places that depend on what is around it and also within quotes, and answers for some
/// (U+031B, found by fuzzing) with undefined behaviour. In quotes an escape says the same: "\u00e9".
[[nodiscard]] int line_of_stray_character(std::string_view text);

/// Dots in a key, and brackets in brackets: the parser and its tree call themselves once for each.
inline constexpr std::size_t kDeepest = 8;

/// The first line with more of them; 0 when there is none.
[[nodiscard]] int line_too_deep(std::string_view text);

/// @param name of the source in messages. @return the tree, or one line that names the source and its line.
[[nodiscard]] std::variant<toml::table, Error> parse_toml(const std::string& text, const std::string& name);

/// The same from a file.
[[nodiscard]] std::variant<toml::table, Error> parse_toml_file(const std::filesystem::path& path);

}  // namespace ligature::scene
