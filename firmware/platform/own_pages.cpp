#include "firmware/platform/own_pages.hpp"

#include <sys/mman.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

namespace ligature::platform {
namespace {

#if defined(MADV_POPULATE_WRITE)
constexpr int kPopulateWrite = MADV_POPULATE_WRITE;
#else
constexpr int kPopulateWrite = 23;  // older headers lack this constant
#endif

struct Mapping {
  std::uintptr_t from, to;
  int protection;
};

/// Private, readable mappings of files.
std::vector<Mapping> file_mappings() {
  std::vector<Mapping> found;
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    unsigned long from = 0, to = 0, inode = 0;
    char may[5] = "";
    // NOLINTNEXTLINE(bugprone-unchecked-string-to-number-conversion): the kernel writes numbers that fit
    if (std::sscanf(line.c_str(), "%lx-%lx %4s %*s %*s %lu", &from, &to, may, &inode) != 4) continue;
    if (inode == 0 || may[0] != 'r' || may[3] != 'p') continue;
    const int protection = PROT_READ | (may[1] == 'w' ? PROT_WRITE : 0) | (may[2] == 'x' ? PROT_EXEC : 0);
    found.push_back({from, to, protection});
  }
  return found;
}

/// Makes the kernel copy every page, as it would at the first write to the page. The mapping stays executable
/// meanwhile, because it may contain this function.
/// @return 0, or the errno
int copy(const Mapping& m) noexcept {
  auto* const at = reinterpret_cast<void*>(m.from);  // NOLINT(performance-no-int-to-ptr): printed by the kernel
  const std::size_t bytes = m.to - m.from;
  if (mprotect(at, bytes, m.protection | PROT_WRITE) != 0) return errno;
  const int error = madvise(at, bytes, kPopulateWrite) == 0 ? 0 : errno;
  return mprotect(at, bytes, m.protection) == 0 || error != 0 ? error : errno;
}

}  // namespace

int own_file_pages() {
  int first = 0;
  for (const auto& m : file_mappings()) {
    const int error = copy(m);
    if (first == 0) first = error;
  }
  return first;
}

}  // namespace ligature::platform
