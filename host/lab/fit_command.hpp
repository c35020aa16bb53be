#pragma once

namespace CLI {
class App;
}

namespace ligature::lab {

/// Adds `ligature-lab fit`.
void add_fit_command(CLI::App& app, int& exit_code);

}  // namespace ligature::lab
