#pragma once
// The `doctor` command: checks the machine's settings, and measures how late it wakes a real-time program.

#include <string>
#include <vector>

#include "firmware/app/doctor/histogram.hpp"
#include "firmware/app/options.hpp"
#include "firmware/platform/machine.hpp"
#include "firmware/rt/cycle_timing.hpp"

namespace ligature::app {

/// Grades the largest wake-up latency without a scene: OK below 100 us, WARN below 300 us. Forces become uneven long
/// before such a delay costs a whole period of 1000 us.
[[nodiscard]] platform::Check judge(const rt::DurationStatistics& wakeup);

/// Grades the largest wake-up latency by the delay that a scene allows (`slack_us`): OK below half of it, WARN below
/// all of it.
[[nodiscard]] platform::Check judge(const LatencyHistogram& wakeup, double slack_us);

/// One row per check: its grade (OK, WARN, FAIL) and what was found. A second line gives the command that corrects it.
[[nodiscard]] std::string table(const std::vector<platform::Check>& checks);

/// Share of wake-ups by latency, in bins whose width doubles.
[[nodiscard]] std::string histogram(const rt::DurationStatistics& wakeup, const std::vector<std::uint64_t>& bins);

/// The `doctor` command. @return the exit code: 0 no FAIL, 3 at least one.
[[nodiscard]] int doctor(const DoctorOptions& options);

}  // namespace ligature::app
