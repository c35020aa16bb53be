#pragma once
// Scheduling of this process.

#include <string>
#include <vector>

namespace ligature::sim {

/// Requests exact timers; if real_time also SCHED_FIFO (below the controller's priority) and locked memory; if cpu >= 0
/// that CPU only. @return one line per refusal; the program works without.
[[nodiscard]] std::vector<std::string> ask_for_scheduling(bool real_time, int cpu);

}  // namespace ligature::sim
