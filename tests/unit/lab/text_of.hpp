#pragma once
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace ligature::lab {

inline std::string text_of(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

}  // namespace ligature::lab
