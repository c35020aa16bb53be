#pragma once

namespace CLI {
class App;
}

namespace ligature::lab {

/// Adds `ligature-lab tie`.
void add_tie_command(CLI::App& app, int& exit_code);

}  // namespace ligature::lab
