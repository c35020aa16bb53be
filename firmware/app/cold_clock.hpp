#pragma once
// How admission measures: CPU time of the calling thread, with cold caches.

#include <cstddef>
#include <vector>

#include "firmware/platform/monotonic_clock.hpp"

namespace ligature::app {

/// CPU time of the calling thread, us.
inline double cpu_us() noexcept { return 1e-3 * static_cast<double>(platform::MonotonicClock{}.worked().count()); }

/// Evicts our data from the CPU's caches before a measurement: on a rig, other programs fill the caches between two
/// ticks.
class ColdCaches {
 public:
  void operator()() noexcept {
    for (std::size_t i = 0; i < bytes_.size(); i += 64) bytes_[i] = static_cast<unsigned char>(bytes_[i] + 1);
    asm volatile("" : : "r"(bytes_.data()) : "memory");
  }

 private:
  static constexpr std::size_t kBytes = 4 << 20;
  std::vector<unsigned char> bytes_ = std::vector<unsigned char>(kBytes, 1);
};

}  // namespace ligature::app
