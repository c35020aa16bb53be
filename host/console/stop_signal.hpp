#pragma once

namespace ligature::console {

/// Makes SIGINT and SIGTERM set the flag that stop_requested() returns, so that the program can close its files in
/// order. Also ignores SIGXFSZ: a file size limit then fails the write with an error, like a full disk.
void catch_stop_signals();

/// Ignores SIGPIPE: recording or exporting continues when the reader of the standard output has gone.
void outlive_closed_pipes();

[[nodiscard]] bool stop_requested() noexcept;

}  // namespace ligature::console
