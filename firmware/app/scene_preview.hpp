#pragma once
#include <filesystem>
#include <span>
#include <string>

#include "ligature_msg/preview_t.hpp"

namespace ligature::app {

/// What people need to choose a scene: the comment at the head of its file, its facts and its start shape. Reads the
/// file and the start shape that it names; simulates nothing. @param overrides those with which the scene would be
/// loaded
[[nodiscard]] ligature_msg::preview_t preview_of(const std::filesystem::path& file,
                                                 std::span<const std::string> overrides);

}  // namespace ligature::app
