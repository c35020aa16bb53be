#pragma once
#include <string>

#include "host/log_summary.hpp"

namespace ligature::host {

/// The table a person reads at the end of a run.
[[nodiscard]] std::string report_table(const LogSummary& summary);

/// The same numbers as one JSON object; SI units, durations in us, as its keys say.
[[nodiscard]] std::string report_json(const LogSummary& summary);

}  // namespace ligature::host
