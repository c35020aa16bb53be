#include "host/lab/scenes_folder.hpp"

#include "host/lab/outcome.hpp"

namespace ligature::lab {

namespace fs = std::filesystem;

fs::path find_scenes(const std::string& given) {
  std::error_code none;
  const auto installed = fs::read_symlink("/proc/self/exe", none).parent_path().parent_path() / "share/ligature/scenes";
  for (const auto& folder : {fs::path(given), fs::path("scenes"), installed, fs::path(LIGATURE_SCENES_DIR)}) {
    if (!folder.empty() && fs::exists(folder / "paper.toml", none)) return folder;
    if (!given.empty()) break;
  }
  throw Refusal("--scenes " + given + ": found no paper.toml, allowed a folder of scenes");
}

}  // namespace ligature::lab
