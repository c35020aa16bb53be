#pragma once
// Interruptions by the firmware of the machine (SMI), which no program can see or prevent. The kernel's tracer `hwlat`
// finds them: it spins with interrupts off and looks for gaps in the time.

#include <optional>
#include <string>

namespace ligature::app {

/// The longest gap in the text of the tracer's file `trace`, us; nothing when it found none.
[[nodiscard]] std::optional<double> longest_gap_us(const std::string& trace);

/// Runs the tracer. @param folder of the kernel's tracing files. @return one line: the longest gap, or why it did not
/// run.
[[nodiscard]] std::string look_for_gaps(const std::string& folder, double seconds);

}  // namespace ligature::app
