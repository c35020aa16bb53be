#pragma once
#include <string>

#include "host/log_summary.hpp"

namespace ligature::host {

/// The report as a table for people.
[[nodiscard]] std::string report_table(const LogSummary& summary);

/// The numbers of report_table() as one JSON object; SI units, but durations in us where the key says so.
[[nodiscard]] std::string report_json(const LogSummary& summary);

}  // namespace ligature::host
