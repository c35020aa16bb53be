#pragma once
// Names the option that was probably meant when an unknown one was given: CLI11 alone only says that it is unknown.

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

namespace ligature::console {

/// Smallest number of letters to change, insert or remove to turn one word into the other.
[[nodiscard]] inline std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0U);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t k = 1; k <= b.size(); ++k) {
      const std::size_t changed = diagonal + (a[i - 1] == b[k - 1] ? 0U : 1U);
      diagonal = row[k];
      row[k] = std::min({changed, row[k] + 1, row[k - 1] + 1});
    }
  }
  return row.back();
}

/// @param app  a CLI::App (a template, so that this folder does not depend on CLI11).
/// @return ", did you mean --forces?" for the first option that the command argv[1] does not have; empty when it has
/// all of them, or when none is similar.
template <class App>
[[nodiscard]] std::string likely_option(App& app, int argc, const char* const* argv) {
  constexpr std::size_t kMostChanges = 2;
  if (argc < 2) return {};
  const auto found = app.get_subcommands([&](const App* each) { return each->get_name() == argv[1]; });
  if (found.empty()) return {};
  const App* command = found.front();
  for (int i = 2; i < argc; ++i) {
    const std::string_view word(argv[i]);
    const std::string given(word.substr(0, word.find('=')));
    if (!given.starts_with("--") || given.size() < 4 || command->get_option_no_throw(given) != nullptr) continue;
    std::string likely;
    std::size_t least = kMostChanges + 1;
    for (const auto* option : command->get_options()) {
      for (const auto& name : option->get_lnames()) {
        const std::size_t changes = edit_distance(given, "--" + name);
        if (changes < least) likely = name;
        least = std::min(least, changes);
      }
    }
    return likely.empty() ? "" : ", did you mean --" + likely + "?";
  }
  return {};
}

}  // namespace ligature::console
