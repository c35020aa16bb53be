#pragma once
#include <span>
#include <string_view>

namespace ligature::host::view {

/// One file of the page, part of this program.
struct PageFile {
  std::string_view path, type, body;
};

/// All of them, made by the build (host/view/CMakeLists.txt).
[[nodiscard]] std::span<const PageFile> page_files();

/// @return the file of a path such as "/main.js" ("/" is index.html), nullptr for none.
[[nodiscard]] const PageFile* find_page_file(std::string_view path);

}  // namespace ligature::host::view
