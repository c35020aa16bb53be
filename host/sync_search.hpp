#pragma once
#include <cstdint>

#include "host/console/progress.hpp"
#include "host/regular_file.hpp"

namespace ligature::host {

/// After this many bytes without an event the file is no log any more, and the search ends.
inline constexpr std::int64_t kMostGarbage = std::int64_t{1} << 30;

/// Offset of the next sync word of a log at or after `from`; -1 when there is no sync word within the next kMostGarbage
/// bytes of data. Holes of a sparse file are skipped and not counted.
/// @param progress may be null. @throws RunFailed on a stop signal.
[[nodiscard]] std::int64_t find_sync(const RegularFile& file, std::int64_t from, console::Progress* progress);

/// @throws RunFailed when a stop signal has come.
void end_when_asked();

}  // namespace ligature::host
