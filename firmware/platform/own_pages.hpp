#pragma once
// Code and constants of a process in memory of its own.

namespace ligature::platform {

/// Gives the process copies of the pages that it shares with the files they come from (program and libraries).
/// mlockall() does not hold all of these: a folio of the page cache that reaches past the end of a mapping stays on the
/// lists of what may be reclaimed, and code that was there faults when it is next run (it fits the one fault that a
/// soak of 600 s had). Copies are anonymous and locked. About 10 MB; milliseconds; before threads with deadlines run.
/// @return 0, or the errno of the first mapping that could not be copied (before Linux 5.14 EINVAL); the others were.
[[nodiscard]] int own_file_pages();

}  // namespace ligature::platform
