// Fuzz target: gripper scripts.
#include "protocol/scene/gripper_script.hpp"
#include "tests/fuzz/target.hpp"

std::vector<std::string> ligature::fuzz::seeds() { return files_in("scenes/operators", ".csv"); }

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const ligature::fuzz::MemoryFile file(data, size);
  (void)ligature::scene::load_gripper_script(file.path());
  return 0;
}
