#pragma once
#include <cmath>
#include <cstdint>
#include <string>

namespace ligature::host {

/// Facts that a reader of a log needs before the first tick.
struct RigFacts {
  double period_s = 1e-3;    // control period; the default when the log has no status message
  double max_force_N = 3.3;  // force limit at the device; the default when the log has no status message
  bool has_status = false;   // false: the two numbers above are defaults
  std::string scene_file, scene_toml;
  std::string firmware_version;

  /// Time of a tick since the start of its session, s. Dividing by an integer rate gives the double nearest to the
  /// decimal number (700 * 0.001 is 0.7000000000000001, 700 / 1000 is 0.7).
  [[nodiscard]] double time_s(std::int64_t tick) const {
    const double rate_Hz = 1.0 / period_s, whole_Hz = std::round(rate_Hz);
    const bool is_whole = std::abs(rate_Hz - whole_Hz) <= 1e-12 * rate_Hz;
    return is_whole ? static_cast<double>(tick) / whole_Hz : static_cast<double>(tick) * period_s;
  }
};

/// Reads a log up to its first status message (sent at 10 Hz, so near the start).
/// @throws BadInput when the file is no LCM log.
[[nodiscard]] RigFacts read_rig_facts(const std::string& log_path);

}  // namespace ligature::host
