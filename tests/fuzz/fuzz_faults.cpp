// Fuzz target: fault scripts.
#include "protocol/scene/fault_script.hpp"
#include "tests/fuzz/target.hpp"

std::vector<std::string> ligature::fuzz::seeds() { return files_in("scenes/faults", ".toml"); }

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const ligature::fuzz::MemoryFile file(data, size);
  (void)ligature::scene::load_fault_script(file.path());
  return 0;
}
