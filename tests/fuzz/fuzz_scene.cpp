// Scene files.
#include "protocol/scene/scene_file.hpp"
#include "tests/fuzz/target.hpp"

std::vector<std::string> ligature::fuzz::seeds() { return files_in("scenes", ".toml"); }

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const ligature::fuzz::MemoryFile file(data, size);
  (void)ligature::scene::load_scene(file.path(), {});
  return 0;
}
