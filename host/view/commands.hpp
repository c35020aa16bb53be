#pragma once

namespace CLI {  // NOLINT(readability-identifier-naming): theirs
class App;
}

namespace ligature::host::view {

/// Adds the subcommands of the page.
void add_view(CLI::App& app);
void add_replay(CLI::App& app);

}  // namespace ligature::host::view
