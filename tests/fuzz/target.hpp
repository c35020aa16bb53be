#pragma once
// A fuzz target: what eats bytes from outside, and sound inputs to start from. With clang each one is a libFuzzer
// program; with any compiler it is a test that eats the seeds and thousands of mutations of them (standalone.cpp).

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace ligature::fuzz {

/// Sound inputs, defined by each target.
[[nodiscard]] std::vector<std::string> seeds();

/// Bytes as a file that exists in memory only, for readers that want a path.
class MemoryFile {
 public:
  MemoryFile(const std::uint8_t* data, std::size_t size) : fd_(memfd_create("fuzz", MFD_CLOEXEC)) {
    for (std::size_t done = 0; done < size;) {
      const auto n = ::write(fd_, data + done, size - done);
      if (n <= 0) break;
      done += static_cast<std::size_t>(n);
    }
  }
  ~MemoryFile() { close(fd_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  [[nodiscard]] std::string path() const { return "/proc/self/fd/" + std::to_string(fd_); }

 private:
  int fd_;
};

/// Every file with that ending in a folder of the source tree.
[[nodiscard]] std::vector<std::string> files_in(const std::string& folder, const std::string& ending);

}  // namespace ligature::fuzz
