#pragma once

namespace CLI {
class App;
}

namespace ligature::lab {

/// Adds the subcommand `pareto`: cost and accuracy of every model.
void add_pareto_command(CLI::App& app, int& exit_code);

}  // namespace ligature::lab
