#pragma once

namespace CLI {
class App;
}

namespace ligature::lab {

/// Adds `ligature-lab validate`: compares the models with references. exit_code becomes 0, or 1 when a case fails.
void add_validate_command(CLI::App& app, int& exit_code);

}  // namespace ligature::lab
