#pragma once
// Exit codes of the lab's commands.

#include <stdexcept>
#include <string>

namespace ligature::lab {

inline constexpr int kDone = 0;
inline constexpr int kMissed = 1;     ///< a result that should be reproduced differs
inline constexpr int kBadInput = 2;   ///< usage, scene or script refused; nothing was written
inline constexpr int kRunFailed = 3;  ///< the run diverged, or a claim does not hold
/// SIGINT or SIGTERM came; the number that shells use for it; finished results are kept
inline constexpr int kInterrupted = 130;

/// Ends the command with one line on stderr and the exit code `code`.
struct Refusal : std::runtime_error {
  explicit Refusal(const std::string& line, int exit_code = kBadInput) : std::runtime_error(line), code(exit_code) {}
  int code;
};

}  // namespace ligature::lab
