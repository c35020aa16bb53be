#include "host/sync_search.hpp"

#include <algorithm>
#include <vector>

#include "host/console/stop_signal.hpp"
#include "host/errors.hpp"
#include "host/log_format.hpp"

namespace ligature::host {

void end_when_asked() {
  if (console::stop_requested()) throw RunFailed("stopped by a signal; what was not complete is not there");
}

std::int64_t find_sync(const RegularFile& file, std::int64_t from, console::Progress* progress) {
  std::vector<unsigned char> block(1U << 20U);
  std::int64_t searched = 0;
  for (std::int64_t at = file.data_after(from); searched < kMostGarbage;) {
    end_when_asked();
    if (progress != nullptr) progress->show(at, file.size());
    const std::size_t got = file.read_at(block.data(), block.size(), at);
    if (got < kLogSync.size()) return -1;
    const auto end = block.begin() + static_cast<std::ptrdiff_t>(got);
    const auto found = std::search(block.begin(), end, kLogSync.begin(), kLogSync.end());
    if (found != end) return at + (found - block.begin());
    const auto passed = static_cast<std::int64_t>(got - (kLogSync.size() - 1));  // a sync word may straddle blocks
    searched += passed;
    at = file.data_after(at + passed);
  }
  return -1;
}

}  // namespace ligature::host
