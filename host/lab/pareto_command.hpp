#pragma once

namespace CLI {
class App;
}

namespace ligature::lab {

/// `pareto`: what accuracy costs, for every model.
void add_pareto_command(CLI::App& app, int& exit_code);

}  // namespace ligature::lab
