#pragma once
// The command line.

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace ligature::app {

/// The loop's computing, as a share of the period: what the bus at its longest leaves it (rt::kMostWork), less a fifth.
inline constexpr double kDefaultBudget_percent = 20.0;

enum class RtMode { kEnforce, kWarn, kOff };

struct RunOptions {
  std::string scene;
  std::vector<std::string> overrides;
  std::string device;  ///< record of both hands' devices; empty: the shipped Omni-class one
  bool override_passivity = false;
  std::string left, right;
  bool arm = false;
  bool exit_on_fault = false;
  std::optional<double> duration_s;
  double wait_s = 10.0;
  std::string lcm_url = "udpm://239.255.76.67:7667?ttl=0";
  bool no_telemetry = false;  ///< say nothing to anybody, hear no commands
  RtMode rt = RtMode::kWarn;
  int physics_core = -1;  ///< of the thread's physics; -1: that of the loop
  int watchdog_ms = 20;
  std::string recorder;  ///< flight recorder file; "none" for none
  int recorder_s = 120;  ///< how far back it goes
  std::string scenes;    ///< folder of the scenes that a command may load; empty: that of `scene`
  bool force = false;    ///< also a scene that is not admitted
  double budget_percent = kDefaultBudget_percent;
  double no_loss_m_per_s = 0.0;            ///< speed of a hand up to which a drawn knot must lose no time; 0: may
  std::string program = "/proc/self/exe";  ///< rehearses what commands ask for, as a child
};

struct RehearseOptions {
  std::string scene;
  std::vector<std::string> overrides;
  std::string text_from;         ///< where the scene's text is read; empty: from `scene`
  double no_loss_m_per_s = 0.0;  ///< as the run's; 0: nothing is measured
};

struct AdmitOptions {
  std::string scene;
  std::vector<std::string> overrides;
  double seconds = 3.0;
  double budget_percent = kDefaultBudget_percent;
  double no_loss_m_per_s = 0.0;
};

struct DoctorOptions {
  double seconds = 10.0;
  std::vector<std::string> can;  ///< interfaces to look at
};

using Command = std::variant<RunOptions, AdmitOptions, RehearseOptions, DoctorOptions>;

struct Exit {
  int code;
};

/// @return what to do, or the exit code when everything is said: help and version (0), bad usage (2, one line on
/// stderr).
[[nodiscard]] std::variant<Command, Exit> parse(int argc, char** argv);

}  // namespace ligature::app
