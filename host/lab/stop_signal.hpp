#pragma once

namespace ligature::lab {

/// From now on SIGINT and SIGTERM only set a flag, so that a run can close its files.
void watch_stop_signals();

/// Has one arrived?
[[nodiscard]] bool stop_requested() noexcept;

}  // namespace ligature::lab
