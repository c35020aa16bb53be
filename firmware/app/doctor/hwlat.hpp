#pragma once
// Finds interruptions by the machine's own firmware (system management interrupts, SMI), which no program can prevent.
// The kernel's tracer `hwlat` detects them: it spins with interrupts off and looks for gaps between clock readings.

#include <atomic>
#include <optional>
#include <string>

namespace ligature::app {

/// The longest gap, us, in `trace`: the text of the tracer's file of that name. Nothing when the tracer found no gap.
[[nodiscard]] std::optional<double> longest_gap_us(const std::string& trace);

/// Runs the tracer for `seconds`, or until `stop` is set. @param folder where the kernel's tracing files are. @return
/// one line: the longest gap, or why it did not run.
[[nodiscard]] std::string look_for_gaps(const std::string& folder, double seconds, const std::atomic<bool>& stop);

}  // namespace ligature::app
