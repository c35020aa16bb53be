#pragma once
// The command line of ligature-device.

#include <string>
#include <variant>
#include <vector>

namespace ligature::sim {

struct Options {
  bool is_left = true;
  std::string bus;
  std::string scene;   ///< empty: default workspace
  std::string script;  ///< empty: the hand rests
  std::string stats;   ///< empty: none
  std::string faults;  ///< empty: nothing goes wrong
  std::vector<std::string> overrides;
  bool exit_when_done = false;
  bool real_time = false;
  int cpu = -1;  ///< -1: any

  [[nodiscard]] std::string hand() const { return is_left ? "left" : "right"; }
};

/// Options, or the exit code of a command line that is over (help, version: 0; a mistake: 2, told in one line).
[[nodiscard]] std::variant<Options, int> parse_options(int argc, char** argv);

}  // namespace ligature::sim
