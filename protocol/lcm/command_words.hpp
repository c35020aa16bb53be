#pragma once
// Names of the kinds of command_t: for the command line, the page and the firmware's answers.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace ligature::lcm_tools {

struct CommandWord {
  std::int8_t kind;  ///< KIND_ of command_t
  std::string_view word;
};

inline constexpr std::array<CommandWord, 13> kCommandWords{{{1, "arm"},
                                                            {2, "disarm"},
                                                            {3, "stop"},
                                                            {4, "reset-fault"},
                                                            {5, "reset-thread"},
                                                            {6, "load-scene"},
                                                            {7, "set"},
                                                            {9, "clutch left"},
                                                            {10, "unclutch left"},
                                                            {11, "clutch right"},
                                                            {12, "unclutch right"},
                                                            {13, "park"},
                                                            {14, "calibrate"}}};

/// Kind for a name; nothing for an unknown name.
[[nodiscard]] constexpr std::optional<std::int8_t> command_kind(std::string_view word) {
  for (const auto& known : kCommandWords)
    if (known.word == word) return known.kind;
  return std::nullopt;
}

/// Name of a kind; "command 99" for an unknown kind.
[[nodiscard]] inline std::string command_word(std::int8_t kind) {
  for (const auto& known : kCommandWords)
    if (known.kind == kind) return std::string(known.word);
  return "command " + std::to_string(kind);
}

}  // namespace ligature::lcm_tools
