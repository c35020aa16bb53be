#pragma once
#include <fstream>
#include <sstream>
#include <string>

namespace ligature::app {

/// A file's content; empty if it cannot be read.
[[nodiscard]] inline std::string file_text(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

}  // namespace ligature::app
