#pragma once
// The report of a machine check. `doctor --report` writes it; `doctor --compare` and `ligature-host plot --latency`
// read it.

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "firmware/app/doctor/histogram.hpp"
#include "firmware/platform/machine.hpp"

namespace ligature::app {

/// A wake-up that was among the latest, and when.
struct LateWakeUp {
  double at_s = 0.0;
  double late_us = 0.0;
};

/// Round trips of a frame on a CAN interface: from the call that sends it until it is read back.
struct CanEcho {
  std::string interface;
  LatencyHistogram round_trips;
  std::uint64_t lost = 0;  ///< did not come back within 10 ms
  std::string problem;     ///< why nothing was measured; empty: it was
  double calls_us = 0.0;   ///< CPU time of sending and reading one frame, median; not in the report
};

struct DoctorReport {
  std::string started;  ///< UTC
  std::string kernel, cpu, ligature;
  int cores = 0, core = 0;
  double seconds = 0.0;  ///< measured, which is less than asked for when the user ended it
  std::vector<std::string> load;
  std::string scene;               ///< empty: none given
  std::optional<double> slack_us;  ///< how late a wake-up may be with that scene
  std::string hardware;            ///< what the hwlat tracer found
  std::vector<platform::Check> checks;
  LatencyHistogram wakeup;
  std::vector<LateWakeUp> worst;
  std::vector<CanEcho> can;
  std::string verdict = "not finished";  ///< until the measurement has ended
};

[[nodiscard]] std::string to_json(const DoctorReport& report);

/// @return the report, or one line about what is wrong with `text`.
[[nodiscard]] std::variant<DoctorReport, std::string> report_of(const std::string& text);

/// Table of two reports side by side. It gives no confidence intervals: they would be wrong, because late wake-ups come
/// in groups.
[[nodiscard]] std::string compare(const DoctorReport& a, const std::string& name_a, const DoctorReport& b,
                                  const std::string& name_b);

}  // namespace ligature::app
