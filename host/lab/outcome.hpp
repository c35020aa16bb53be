#pragma once
// How a command of the lab ends.

#include <stdexcept>
#include <string>

namespace ligature::lab {

inline constexpr int kDone = 0;
inline constexpr int kMissed = 1;         ///< what should come out the same does not
inline constexpr int kBadInput = 2;       ///< usage, scene or script refused; nothing was written
inline constexpr int kRunFailed = 3;      ///< diverged, or a claim does not hold
inline constexpr int kInterrupted = 130;  ///< by SIGINT or SIGTERM, as shells say it; what was done is kept

/// Ends the command with one line on stderr.
struct Refusal : std::runtime_error {
  explicit Refusal(const std::string& line, int exit_code = kBadInput) : std::runtime_error(line), code(exit_code) {}
  int code;
};

}  // namespace ligature::lab
