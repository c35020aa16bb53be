#pragma once

namespace CLI {
class App;
}

namespace ligature::host::view {

/// Add the subcommands `view` and `replay`.
void add_view(CLI::App& app);
void add_replay(CLI::App& app);

}  // namespace ligature::host::view
