#include <filesystem>
#include <fstream>
#include <sstream>

#include "ligature_source_dir.hpp"
#include "tests/fuzz/target.hpp"

namespace ligature::fuzz {

std::vector<std::string> files_in(const std::string& folder, const std::string& ending) {
  std::vector<std::string> texts;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(LIGATURE_SOURCE_DIR) + "/" + folder)) {
    if (entry.path().extension() != ending) continue;
    std::ostringstream text;
    text << std::ifstream(entry.path(), std::ios::binary).rdbuf();
    texts.push_back(text.str());
  }
  return texts;
}

}  // namespace ligature::fuzz
