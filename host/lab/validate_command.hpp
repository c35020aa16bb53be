#pragma once

namespace CLI {
class App;
}

namespace ligature::lab {

/// `validate`: the models against references with a known answer. exit_code receives 0, or 1 when a case fails.
void add_validate_command(CLI::App& app, int& exit_code);

}  // namespace ligature::lab
