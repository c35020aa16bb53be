#pragma once
// TOML text to a tree, for the readers of scene, device and fault files.

#include <filesystem>
#include <string>
#include <string_view>
#include <variant>

#include "protocol/scene/strict_table.hpp"

namespace ligature::scene {

/// The first line with a byte outside ASCII that is neither in a comment nor in quotes; 0 when there is none.
/// No key and no value of ours has one, and toml++ 3.0 answers some of them (U+031B in a value's place, found by
/// fuzzing) with undefined behaviour instead of an error.
[[nodiscard]] int line_of_stray_character(std::string_view text);

/// @param name of the source in messages. @return the tree, or one line that names the source and its line.
[[nodiscard]] std::variant<toml::table, Error> parse_toml(const std::string& text, const std::string& name);

/// The same from a file.
[[nodiscard]] std::variant<toml::table, Error> parse_toml_file(const std::filesystem::path& path);

}  // namespace ligature::scene
