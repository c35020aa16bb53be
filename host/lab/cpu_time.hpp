#pragma once
#include <ctime>

namespace ligature::lab {

/// CPU time of this thread, us: what a tick costs, whatever else the machine is doing.
[[nodiscard]] inline double thread_cpu_us() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e6 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_nsec);
}

}  // namespace ligature::lab
