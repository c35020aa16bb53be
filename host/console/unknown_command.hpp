#pragma once
// A first word that is no command, refused by name: the parser alone would only say that a command is missing.

#include <string>

namespace ligature::console {

/// @param app  a CLI::App (this folder does not know the library). @return what to say of argv[1], or nothing when it
/// is a command, an option or not there.
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
