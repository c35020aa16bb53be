#pragma once
#include <cstdint>

#include "host/console/progress.hpp"
#include "host/regular_file.hpp"

namespace ligature::host {

/// More than that without one event is no log any more: what follows is given up.
inline constexpr std::int64_t kMostGarbage = std::int64_t{1} << 30;

/// Offset of the next sync word of a log at or after an offset; -1 when there is none, or none within kMostGarbage
/// bytes of data. Holes of a sparse file are passed over and not counted.
/// @param progress may be null. @throws RunFailed when a signal asks for the end.
[[nodiscard]] std::int64_t find_sync(const RegularFile& file, std::int64_t from, console::Progress* progress);

/// @throws RunFailed when a signal has asked for the end.
void end_when_asked();

}  // namespace ligature::host
