#pragma once
// Command line of ligature-firmware.

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace ligature::app {

/// Default budget of the loop's computing, in percent of a period: four fifths of the time that the bus leaves with our
/// own drives (rt::BusTime::most_work()).
inline constexpr double kDefaultBudget_percent = 20.0;

inline constexpr int kDefaultWatchdog_ms = 20;

enum class RtMode { kEnforce, kWarn, kOff };

struct RunOptions {
  std::string scene;
  std::vector<std::string> overrides;
  std::string device;  ///< device record for both hands; empty: the built-in Omni-class record
  bool override_passivity = false;
  bool accept_no_drive_watchdog = false;
  std::string left, right;
  bool arm = false;
  bool exit_on_fault = false;
  std::optional<double> duration_s;
  double wait_s = 10.0;
  std::string lcm_url = "udpm://239.255.76.67:7667?ttl=0";
  bool no_telemetry = false;  ///< neither publish nor accept commands
  RtMode rt = RtMode::kWarn;
  int physics_core = -1;  ///< core of the physics thread; -1: the loop's core
  int watchdog_ms = kDefaultWatchdog_ms;
  std::string recorder;  ///< flight recorder file; "none" for none
  int recorder_s = 120;  ///< length of the recorded history
  std::string scenes;    ///< folder of scenes that commands may load; empty: the folder of `scene`
  bool force = false;    ///< run even if admission refuses
  double budget_percent = kDefaultBudget_percent;
  double no_loss_m_per_s = 0.0;  ///< hand speed up to which drawing a knot must lose no time; 0: no such demand
  /// Executable that the controller starts as a child process to rehearse a scene that a command wants to load
  std::string program = "/proc/self/exe";
};

struct RehearseOptions {
  std::string scene;
  std::vector<std::string> overrides;
  std::string text_from;         ///< file that holds the scene's text; empty: `scene` itself
  double no_loss_m_per_s = 0.0;  ///< as in RunOptions; 0: time loss is not measured
};

struct AdmitOptions {
  std::string scene;
  std::string device;            ///< as in RunOptions
  std::vector<std::string> can;  ///< CAN interfaces whose drivers' time counts
  std::vector<std::string> overrides;
  double seconds = 3.0;
  double budget_percent = kDefaultBudget_percent;
  double no_loss_m_per_s = 0.0;
};

struct DoctorOptions {
  std::string device;                     ///< device record whose drives are judged; empty: none
  int watchdog_ms = kDefaultWatchdog_ms;  ///< the one that `run` will have
  double seconds = 10.0;
  double hours = 0.0;                ///< instead of `seconds`, when above 0
  std::vector<std::string> can;      ///< CAN interfaces to check
  bool load = false;                 ///< keep the machine busy while measuring
  std::string scene;                 ///< judge by what it leaves; empty: default scene or fixed bounds (doctor.cpp)
  std::string report;                ///< file for the report; empty: none
  std::vector<std::string> compare;  ///< two reports to print side by side, and nothing else

  [[nodiscard]] double duration_s() const { return hours > 0.0 ? 3600.0 * hours : seconds; }
  /// Whether an acceptance test of the machine was requested. Such a test also sends frames on the CAN interfaces, and
  /// looks for interruptions by the machine's firmware.
  [[nodiscard]] bool is_acceptance() const { return hours > 0.0 || load || !report.empty(); }
};

using Command = std::variant<RunOptions, AdmitOptions, RehearseOptions, DoctorOptions>;

struct Exit {
  int code;
};

/// @return the command to run, or the exit code if nothing is left to do: help and version (0), bad usage (2, one line
/// on stderr).
[[nodiscard]] std::variant<Command, Exit> parse(int argc, char** argv);

}  // namespace ligature::app
