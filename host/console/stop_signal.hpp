#pragma once

namespace ligature::console {

/// From now on SIGINT and SIGTERM are requests, seen by stop_requested(), so that files are closed in order.
/// Also ignores SIGXFSZ: a full quota is then an error of the write that met it, like a full disk.
void catch_stop_signals();

/// The same for SIGPIPE: what records or exports goes on when whoever read its words has gone.
void outlive_closed_pipes();

[[nodiscard]] bool stop_requested() noexcept;

}  // namespace ligature::console
