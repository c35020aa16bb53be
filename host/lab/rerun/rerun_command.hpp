#pragma once

namespace CLI {
class App;
}

namespace ligature::lab {

/// Adds `ligature-lab rerun`.
void add_rerun_command(CLI::App& app, int& exit_code);

}  // namespace ligature::lab
