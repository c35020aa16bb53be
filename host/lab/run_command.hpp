#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace ligature::lab {

/// Adds `ligature-lab run`; its callback stores the exit code.
void add_run_command(CLI::App& app, int& exit_code);

}  // namespace ligature::lab
