#pragma once

namespace CLI {
class App;
}

namespace ligature::lab {

/// Adds `ligature-lab published`: compares the rod with experiments that others published. exit_code becomes 0, or 3
/// when a case misses.
void add_published_command(CLI::App& app, int& exit_code);

}  // namespace ligature::lab
