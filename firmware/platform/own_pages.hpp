#pragma once
// Private copies of the process's code and constants, so that they cannot be evicted from memory.

namespace ligature::platform {

/// Replaces all pages that are shared with files (program and libraries) by private copies. mlockall() alone does not
/// keep all of them: a page-cache folio that extends beyond a mapping's end stays reclaimable, so code in it can fault
/// when it is next executed (probably the cause of the one fault seen in a soak of 600 s). The copies are anonymous and
/// locked. About 10 MB; takes milliseconds; call before threads with deadlines run.
/// @return 0, or the errno of the first mapping that could not be copied (EINVAL before Linux 5.14); all others are
/// copied
[[nodiscard]] int own_file_pages();

}  // namespace ligature::platform
