#pragma once

namespace CLI {
class App;
}

namespace ligature::host::view {

/// Adds the subcommands of the page.
void add_view(CLI::App& app);
void add_replay(CLI::App& app);

}  // namespace ligature::host::view
