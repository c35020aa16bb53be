#pragma once
// Interface of a fuzz target: a function that reads untrusted bytes, and valid inputs to start from. With clang each
// target is a libFuzzer program; with any compiler it is a test that reads the seeds and thousands of mutations of them
// (standalone.cpp).

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace ligature::fuzz {

/// Valid inputs from which mutations start; each target defines its own.
[[nodiscard]] std::vector<std::string> seeds();

/// Bytes as an in-memory file (memfd), for readers that take a path.
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

/// Contents of all files in a source folder whose names end in `ending`.
[[nodiscard]] std::vector<std::string> files_in(const std::string& folder, const std::string& ending);

}  // namespace ligature::fuzz
