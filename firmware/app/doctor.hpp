#pragma once
// Whether this machine can hold the rate: how it is set up, and how late it wakes up.

#include <string>
#include <vector>

#include "firmware/app/options.hpp"
#include "firmware/platform/machine.hpp"
#include "firmware/rt/cycle_timing.hpp"

namespace ligature::app {

/// Verdict on the largest wake-up latency. The loop has 1000 us less admission's "in all" to spare; a rig feels
/// jitter long before it loses a period.
[[nodiscard]] platform::Check judge(const rt::DurationStatistics& wakeup);

/// One row a check: OK, WARN or FAIL, what was found, and under it the command that mends it.
[[nodiscard]] std::string table(const std::vector<platform::Check>& checks);

/// Share of wake-ups by latency, in bins that double.
[[nodiscard]] std::string histogram(const rt::DurationStatistics& wakeup, const std::vector<std::uint64_t>& bins);

/// @return the exit code: 0 no FAIL, 3 at least one.
[[nodiscard]] int doctor(const DoctorOptions& options);

}  // namespace ligature::app
