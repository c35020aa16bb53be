#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace ligature::host::view {

inline constexpr std::size_t kMostRecordings = 200;
inline constexpr std::size_t kLongestRecordingName = 64;

/// Whether a name consists of letters, digits, '-', '_' and '.', does not start with '.', and is not too long.
[[nodiscard]] bool is_file_name(std::string_view name);

/// The recordings in a folder that a page may name, newest first: {name, bytes, modified_s}, modified_s in Unix time.
/// At most kMostRecordings; empty when the folder cannot be read.
[[nodiscard]] nlohmann::json recordings_in(const std::filesystem::path& folder);

/// Their names, in the order of the alphabet.
[[nodiscard]] std::vector<std::string> recording_names(const std::filesystem::path& folder);

}  // namespace ligature::host::view
