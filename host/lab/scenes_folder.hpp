#pragma once
// Finds the folder of the scenes that Ligature ships.

#include <filesystem>
#include <string>

namespace ligature::lab {

/// The scenes folder: as given, else ./scenes, else the one installed beside the program, else that of the source tree.
/// @throws Refusal when there is none.
[[nodiscard]] std::filesystem::path find_scenes(const std::string& given);

}  // namespace ligature::lab
