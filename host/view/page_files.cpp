#include "host/view/page_files.hpp"

#include <algorithm>

namespace ligature::host::view {

const PageFile* find_page_file(std::string_view path) {
  if (path == "/") path = "/index.html";
  const auto files = page_files();
  const auto found = std::ranges::find(files, path, &PageFile::path);
  return found == files.end() ? nullptr : &*found;
}

}  // namespace ligature::host::view
