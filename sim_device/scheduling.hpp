#pragma once
// What this process asks of the machine.

#include <string>
#include <vector>

namespace ligature::sim {

/// Timers to the microsecond; with real_time also SCHED_FIFO (below the controller's priority) and locked memory; with
/// cpu >= 0 that CPU only. Returns what was refused, a line each; the program works without.
[[nodiscard]] std::vector<std::string> ask_for_scheduling(bool real_time, int cpu);

}  // namespace ligature::sim
