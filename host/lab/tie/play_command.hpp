#pragma once

namespace CLI {
class App;
}

namespace ligature::lab {

/// Adds `ligature-lab play`.
void add_play_command(CLI::App& app, int& exit_code);

}  // namespace ligature::lab
