#pragma once
// The `doctor` command: checks the machine's settings and measures how late it wakes up.

#include <string>
#include <vector>

#include "firmware/app/doctor/histogram.hpp"
#include "firmware/app/options.hpp"
#include "firmware/platform/machine.hpp"
#include "firmware/rt/cycle_timing.hpp"

namespace ligature::app {

/// Grades the largest wake-up latency. What the loop can tolerate is 1000 us minus the total in admission's table, but
/// forces become uneven long before a period is lost.
[[nodiscard]] platform::Check judge(const rt::DurationStatistics& wakeup);

/// Grades it by what a scene leaves: OK below half of `slack_us`, WARN below it.
[[nodiscard]] platform::Check judge(const LatencyHistogram& wakeup, double slack_us);

/// One row per check: OK, WARN or FAIL and what was found; below it the command that corrects it.
[[nodiscard]] std::string table(const std::vector<platform::Check>& checks);

/// Share of wake-ups by latency, in bins whose width doubles.
[[nodiscard]] std::string histogram(const rt::DurationStatistics& wakeup, const std::vector<std::uint64_t>& bins);

/// The `doctor` command. @return the exit code: 0 no FAIL, 3 at least one.
[[nodiscard]] int doctor(const DoctorOptions& options);

}  // namespace ligature::app
