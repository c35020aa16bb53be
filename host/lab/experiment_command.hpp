#pragma once

namespace CLI {
class App;
}

namespace ligature::lab {

/// `ligature-lab experiment`, `stability`, `extremes` and `bench`.
void add_experiment_commands(CLI::App& app, int& exit_code);

}  // namespace ligature::lab
