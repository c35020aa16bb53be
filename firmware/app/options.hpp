#pragma once
// The command line.

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace ligature::app {

enum class RtMode { kEnforce, kWarn, kOff };

struct RunOptions {
  std::string scene;
  std::vector<std::string> overrides;
  std::string left, right;
  bool arm = false;
  bool exit_on_fault = false;
  std::optional<double> duration_s;
  double wait_s = 10.0;
  std::string lcm_url = "udpm://239.255.76.67:7667?ttl=0";
  RtMode rt = RtMode::kWarn;
  int watchdog_ms = 20;
  std::string recorder;    ///< flight recorder file; "none" for none
  int recorder_s = 120;    ///< how far back it goes
};

struct Exit {
  int code;
};

/// @return what to run, or the exit code when everything is said: help and version (0), bad usage (2, one line on
/// stderr).
[[nodiscard]] std::variant<RunOptions, Exit> parse(int argc, char** argv);

}  // namespace ligature::app
