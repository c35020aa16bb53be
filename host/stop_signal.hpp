#pragma once

namespace ligature::host {

/// From now on SIGINT and SIGTERM are requests, seen by stop_requested(), so that files are closed in order.
/// Also ignores SIGXFSZ and SIGPIPE: a full quota or a closed pipe is then an error of the write that met it.
void catch_stop_signals();

[[nodiscard]] bool stop_requested() noexcept;

}  // namespace ligature::host
