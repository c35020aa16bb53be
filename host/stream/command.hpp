#pragma once

namespace CLI {
class App;
}

namespace ligature::host::stream {

/// Adds the subcommand `stream`.
void add_stream(CLI::App& app);

}  // namespace ligature::host::stream
