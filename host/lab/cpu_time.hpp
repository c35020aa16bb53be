#pragma once
// The clock of studies that measure computing time.

#include <ctime>

namespace ligature::lab {

/// CPU time of the calling thread, us: the cost of a tick, independent of the machine's other load. Linux includes
/// interrupts and time stolen by the hypervisor.
[[nodiscard]] inline double thread_cpu_us() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e6 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_nsec);
}

}  // namespace ligature::lab
