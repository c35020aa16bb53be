#pragma once

namespace CLI {
class App;
}

namespace ligature::lab {

/// Adds the command `regress`.
void add_regress_command(CLI::App& app, int& exit_code);

}  // namespace ligature::lab
