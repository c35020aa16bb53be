#pragma once
// Finds what delays a wake-up. Debian's program `rtla` runs the kernel's tracer `timerlat`: a kernel thread wakes up
// every millisecond, and the trace names the interrupts and threads that ran in between.

#include <string>

namespace ligature::app {

/// What delayed the last wake-up in `trace`, the text of timerlat's trace: one line with the wake-up's delay, the delay
/// of its timer interrupt, what this interrupted if it was late itself, and the longest interruptions that ended within
/// the delay. Empty if the trace has no wake-up.
[[nodiscard]] std::string delayed_by(const std::string& trace);

/// Runs the tracer on a core until a wake-up is late by `least_us`, for `seconds` at most. Needs root.
/// @param priority of the tracer's thread (SCHED_FIFO), that of the loop: what has a lower one cannot delay it
/// @return one line: what delayed that wake-up; that none was so late; or why the tracer did not run
[[nodiscard]] std::string look_for_culprit(int core, int priority, double least_us, double seconds);

}  // namespace ligature::app
