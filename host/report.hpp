#pragma once
#include <string>

#include "host/log_summary.hpp"

namespace ligature::host {

/// The report as a table for people.
[[nodiscard]] std::string report_table(const LogSummary& summary);

/// The same numbers as one JSON object; SI units, durations in us as the keys say.
[[nodiscard]] std::string report_json(const LogSummary& summary);

}  // namespace ligature::host
