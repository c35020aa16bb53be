#pragma once
// Names an unknown subcommand in the error message: CLI11 alone would only say that a command is missing.

#include <string>

namespace ligature::console {

/// @param app  a CLI::App (a template, so that this folder does not depend on CLI11).
/// @return the error message for argv[1]; empty when it is a command, an option or absent.
template <class App>
[[nodiscard]] std::string unknown_command(const App& app, int argc, const char* const* argv) {
  if (argc < 2 || argv[1][0] == '-') return {};
  std::string allowed;
  for (const auto* command : app.get_subcommands([](const App*) { return true; })) {
    if (command->get_name() == argv[1]) return {};
    allowed += (allowed.empty() ? "" : ", ") + command->get_name();
  }
  return "found command '" + std::string(argv[1]) + "', allowed " + allowed;
}

}  // namespace ligature::console
