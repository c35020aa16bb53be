#pragma once
#include <filesystem>
#include <span>
#include <string>

#include "ligature_msg/preview_t.hpp"

namespace ligature::app {

/// What a scene file says about itself, its facts and its start shape, for people who choose a scene. Reads the file
/// and a start shape that it names; simulates nothing. @param overrides with which the scene would be loaded
[[nodiscard]] ligature_msg::preview_t preview_of(const std::filesystem::path& file,
                                                 std::span<const std::string> overrides);

}  // namespace ligature::app
